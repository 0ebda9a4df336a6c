#include "render/scene_file.h"

#include "base/die.h"

#include <libconfig.h>
#include <libgen.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIDE_MAX 16384
#define TEXT_MAX (1 << 20)
#define KEYS_MAX 4096          /* libconfig looks for each key among those before */

static void bad(const char *path, const config_setting_t *at, const char *fmt, ...) __attribute__((noreturn, format(printf, 3, 4)));
static void bad(const char *path, const config_setting_t *at, const char *fmt, ...)
{
	char text[512];
	va_list args;
	va_start(args, fmt);
	vsnprintf(text, sizeof text, fmt, args);
	va_end(args);
	die(path, "line %u: %s", config_setting_source_line(at), text);
}

/* Where a setting stands: "camera.fov", "lights[1].radiance[0]". */
#define KEY_MAX 128
static const char *key_of(const config_setting_t *s, char text[KEY_MAX])
{
	const config_setting_t *group = config_setting_parent(s);
	char above[KEY_MAX] = "";
	if (group && !config_setting_is_root(group))
		key_of(group, above);
	if (config_setting_name(s))
		snprintf(text, KEY_MAX, "%.80s%s%.40s", above, *above ? "." : "", config_setting_name(s));
	else
		snprintf(text, KEY_MAX, "%.80s[%d]", above, config_setting_index(s));
	return text;
}
#define KEY(s) key_of(s, (char[KEY_MAX]){ 0 })

/* Every key of a group must be one of the words. */
static void only(const char *path, const config_setting_t *group, const char *words)
{
	if (!config_setting_is_group(group))
		bad(path, group, "%s must be one group { .. } (known there: %s)", KEY(group), words);
	for (int i = 0; i < config_setting_length(group); i++) {
		const config_setting_t *s = config_setting_get_elem(group, (unsigned)i);
		const char *name = config_setting_name(s);
		size_t n = strlen(name);
		int known = 0;
		for (const char *w = words; *w; w += strcspn(w, " "), w += *w == ' ')
			known |= strcspn(w, " ") == n && !strncmp(w, name, n);
		if (!known)
			bad(path, s, "unknown key '%s' (known here: %s)", name, words);
	}
}

static double value(const char *path, const config_setting_t *s)
{
	double v = NAN;
	switch (config_setting_type(s)) {
	case CONFIG_TYPE_INT: v = config_setting_get_int(s); break;
	case CONFIG_TYPE_INT64: v = (double)config_setting_get_int64(s); break;
	case CONFIG_TYPE_FLOAT: v = config_setting_get_float(s); break;
	default: bad(path, s, "%s must be a number", KEY(s));
	}
	if (!isfinite(v))
		bad(path, s, "%s must be finite", KEY(s));
	return v;
}

static config_setting_t *need(const char *path, config_setting_t *group, const char *name)
{
	config_setting_t *s = config_setting_get_member(group, name);
	if (!s)
		bad(path, group, "%s needs a key '%s'", KEY(group), name);
	return s;
}

static double number(const char *path, config_setting_t *group, const char *name, double low, double high)
{
	config_setting_t *s = need(path, group, name);
	double v = value(path, s);
	if (!(v >= low && v <= high))
		bad(path, s, "%s %g is out of range (%g to %g)", KEY(s), v, low, high);
	return v;
}

static void numbers(const char *path, config_setting_t *s, int n, double *out)
{
	if (!config_setting_is_aggregate(s) || config_setting_is_group(s) || config_setting_length(s) != n)
		bad(path, s, "%s must be %d numbers [a, b%s]", KEY(s), n, n == 3 ? ", c" : "");
	for (int i = 0; i < n; i++) {
		out[i] = value(path, config_setting_get_elem(s, (unsigned)i));
		if (!(fabs(out[i]) <= 1e9))
			bad(path, s, "%s %g is out of range (at most 1e9)", KEY(s), out[i]);
	}
}

static void optional3(const char *path, config_setting_t *group, const char *name, double *out)
{
	config_setting_t *s = config_setting_get_member(group, name);
	if (s)
		numbers(path, s, 3, out);
}

static void camera(const char *path, config_setting_t *g, struct scenefile *s)
{
	double size[2];
	only(path, g, "position target up fov resolution");
	optional3(path, g, "position", s->position);
	numbers(path, need(path, g, "target"), 3, s->target);
	optional3(path, g, "up", s->up);
	s->fov = number(path, g, "fov", 1e-6, 179);
	config_setting_t *resolution = need(path, g, "resolution");
	numbers(path, resolution, 2, size);
	if (size[0] != floor(size[0]) || size[1] != floor(size[1]) || size[0] < 1 || size[1] < 1 || size[0] > SIDE_MAX || size[1] > SIDE_MAX)
		bad(path, resolution, "camera.resolution is two whole numbers from 1 to %d", SIDE_MAX);
	s->width = (int)size[0];
	s->height = (int)size[1];
	double d[3], c[3], n = 0;
	for (int i = 0; i < 3; i++)
		d[i] = s->target[i] - s->position[i];
	for (int i = 0; i < 3; i++) {
		c[i] = d[(i + 1) % 3] * s->up[(i + 2) % 3] - d[(i + 2) % 3] * s->up[(i + 1) % 3];
		n += c[i] * c[i];
	}
	if (!(n > 0) || !isfinite(n))
		bad(path, g, "camera: position, target and up do not span a view");
}

/* A strength: one number for white, or linear RGB. */
static void strength(const char *path, config_setting_t *group, const char *name, double *rgb)
{
	config_setting_t *s = need(path, group, name);
	if (config_setting_is_aggregate(s))
		numbers(path, s, 3, rgb);
	else
		rgb[0] = rgb[1] = rgb[2] = value(path, s);
	for (int i = 0; i < 3; i++)
		if (!(rgb[i] >= 0 && rgb[i] <= 1e9))
			bad(path, s, "%s %g is out of range (0 to 1e+09)", KEY(s), rgb[i]);
}

/* The scene's folder and a relative name make a path. */
static char *beside(const char *scene, const char *name)
{
	if (*name == '/')
		return xtext("%s", name);
	char *copy = xtext("%s", scene), *path = xtext("%s/%s", dirname(copy), name);
	free(copy);
	return path;
}

static void sun(const char *path, config_setting_t *g, struct sun *sun)
{
	only(path, g, "type direction irradiance angle");
	config_setting_t *direction = need(path, g, "direction");
	numbers(path, direction, 3, sun->direction);
	double length = fabs(sun->direction[0]) + fabs(sun->direction[1]) + fabs(sun->direction[2]);
	if (!(length > 1e-9))
		bad(path, direction, "%s must be longer than 1e-9", KEY(direction));
	strength(path, g, "irradiance", sun->irradiance);
	sun->angle = config_setting_get_member(g, "angle") ? number(path, g, "angle", 0, 180) : 0;
	if (sun->angle > 0 && sun->angle < 0.01)
		bad(path, g, "%s.angle is 0 (parallel light) or at least 0.01 degrees", KEY(g));
}

static void quad(const char *path, config_setting_t *g, struct quad *quad)
{
	double *a = quad->edge[0], *b = quad->edge[1], normal2 = 0, a2 = 0, b2 = 0;
	only(path, g, "type corner edge1 edge2 radiance");
	numbers(path, need(path, g, "corner"), 3, quad->corner);
	numbers(path, need(path, g, "edge1"), 3, a);
	numbers(path, need(path, g, "edge2"), 3, b);
	strength(path, g, "radiance", quad->radiance);
	for (int i = 0; i < 3; i++) {
		normal2 += pow(a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3], 2);
		a2 += a[i] * a[i];
		b2 += b[i] * b[i];
	}
	if (!(a2 > 1e-24 && a2 < 1e18 && b2 > 1e-24 && b2 < 1e18 && normal2 > 1e-8 * a2 * b2))
		bad(path, g, "%s: edge1 and edge2 do not span a quad (from 1e-12 to 1e9 m, at an angle above 1e-4)", KEY(g));
}

static void light(const char *path, config_setting_t *g, struct scenefile *s)
{
	double rgb[3] = { 1, 1, 1 };
	if (!config_setting_is_group(g))
		bad(path, g, "%s must be a group { type = ..; }", KEY(g));
	config_setting_t *t = need(path, g, "type"), *file = config_setting_get_member(g, "file");
	const char *type = config_setting_get_string(t);
	int sky = type && !strcmp(type, "environment");
	if ((!sky || file) && s->n_lights + (s->map.width > 0) == MAX_LIGHTS)
		bad(path, g, "more than %d suns, quads and maps", MAX_LIGHTS);
	if (sky && file) {
		only(path, g, "type file radiance");
		const char *name = config_setting_get_string(file);
		if (!name || !*name)
			bad(path, file, "%s must be a string", KEY(file));
		if (s->map.width)
			bad(path, g, "a second environment map");
		if (config_setting_get_member(g, "radiance"))
			strength(path, g, "radiance", rgb);
		char *map = beside(path, name);
		envmap_read(map, rgb, &s->map);
		free(map);
	} else if (sky) {
		only(path, g, "type radiance file");
		strength(path, g, "radiance", rgb);
		for (int i = 0; i < 3; i++)
			s->environment[i] += rgb[i];
	} else if (type && !strcmp(type, "sun")) {
		s->light[s->n_lights].kind = LIGHT_SUN;
		sun(path, g, &s->light[s->n_lights++].sun);
	} else if (type && !strcmp(type, "quad")) {
		s->light[s->n_lights].kind = LIGHT_QUAD;
		quad(path, g, &s->light[s->n_lights++].quad);
	} else {
		bad(path, t, "%s must be \"environment\", \"sun\" or \"quad\"", KEY(t));
	}
}

const char *const scene_transport[] = { "explicit", "fat-ray", "grid", "continuous", NULL };

static void medium(const char *path, config_setting_t *g, struct scene_medium *m)
{
	only(path, g, "file position transport");
	const char *name = config_setting_get_string(need(path, g, "file"));
	if (!name || !*name)
		bad(path, g, "%s.file must be a string", KEY(g));
	m->file = beside(path, name);
	optional3(path, g, "position", m->position);
	m->transport = -1;
	config_setting_t *t = config_setting_get_member(g, "transport");
	if (!t)
		return;
	const char *asked = config_setting_get_string(t);
	for (int i = 0; asked && scene_transport[i]; i++)
		m->transport = strcmp(asked, scene_transport[i]) ? m->transport : i;
	if (m->transport < 0)
		bad(path, t, "%s must be \"explicit\", \"fat-ray\", \"grid\" or \"continuous\"", KEY(t));
}

/* One medium = { .. }, or media = ( { .. }, { .. } ). */
static void media(const char *path, config_setting_t *root, struct scenefile *s)
{
	config_setting_t *one = config_setting_get_member(root, "medium"), *several = config_setting_get_member(root, "media");
	if (!one == !several)
		die(path, one ? "has both 'medium' and 'media'" : "needs a group 'medium', or a list 'media'");
	if (one && config_setting_is_list(one))
		bad(path, one, "medium must be one group { .. }; several are media = ( {..}, {..} )");
	if (one) {
		medium(path, one, &s->medium[s->n_media++]);
		return;
	}
	if (!config_setting_is_list(several) || !config_setting_length(several))
		bad(path, several, "media must be a list ( {..}, {..} )");
	if (config_setting_length(several) > MAX_VOLUMES)
		bad(path, several, "more than %d media", MAX_VOLUMES);
	while (s->n_media < config_setting_length(several)) {
		medium(path, config_setting_get_elem(several, (unsigned)s->n_media), &s->medium[s->n_media]);
		s->n_media++;
	}
}

static void list(FILE *f, int n, const double *v)
{
	for (int i = 0; i < n; i++)
		fprintf(f, "%c%.17g", i ? ',' : ' ', v[i]);
}

static void list_light(FILE *f, const struct scene_light *l)
{
	if (l->kind == LIGHT_SUN) {
		fprintf(f, " sun");
		list(f, 3, l->sun.direction);
		list(f, 3, l->sun.irradiance);
		list(f, 1, &l->sun.angle);
	} else {
		fprintf(f, " quad");
		list(f, 3, l->quad.corner);
		list(f, 3, l->quad.edge[0]);
		list(f, 3, l->quad.edge[1]);
		list(f, 3, l->quad.radiance);
	}
}

static char *canonical(const struct scenefile *s)
{
	char *text, *end;
	size_t size;
	FILE *f = open_memstream(&text, &size);
	if (!f)
		die(NULL, "out of memory");
	fprintf(f, "scene camera %.17g,%.17g,%.17g %.17g,%.17g,%.17g %.17g,%.17g,%.17g %.17g %dx%d", s->position[0], s->position[1],
	        s->position[2], s->target[0], s->target[1], s->target[2], s->up[0], s->up[1], s->up[2], s->fov, s->width, s->height);
	for (int i = 0; i < s->n_media; i++) {
		fprintf(f, " medium");
		list(f, 3, s->medium[i].position);
		if (s->medium[i].transport >= 0)
			fprintf(f, " %s", scene_transport[s->medium[i].transport]);
	}
	fprintf(f, " environment");
	list(f, 3, s->environment);
	for (int kind = LIGHT_SUN; kind <= LIGHT_QUAD; kind++)
		for (int i = 0; i < s->n_lights; i++)
			if (s->light[i].kind == kind)
				list_light(f, &s->light[i]);
	if (s->map.width) {
		fprintf(f, " map %dx%d crc %08x", s->map.width, s->map.height, s->map.crc);
		list(f, 3, s->map.scale);
	}
	if (s->has_ground)
		fprintf(f, " ground %.17g %.17g", s->ground_height, s->ground_albedo);
	fclose(f);
	end = xtext("%s\n", text);
	free(text);
	return end;
}

/* The text of a scene. libconfig's own reading of files, and of files that they include, exits without a line of ours where it
 * fails. */
static char *whole(const char *path, FILE *f)
{
	size_t n = 0;
	char *text = xalloc(TEXT_MAX + 2, 1);
	n = fread(text, 1, TEXT_MAX + 1, f);
	if (ferror(f))
		die(path, "cannot read:");
	if (n > TEXT_MAX)
		die(path, "is larger than %d bytes", TEXT_MAX);
	if (strlen(text) != n)
		die(path, "has a NUL byte");
	int keys = 0;
	for (const char *c = text; *(c += strcspn(c, "=:")); c++)
		if (++keys > KEYS_MAX)
			die(path, "has more than %d keys", KEYS_MAX);
	for (const char *line = text; line; line = strchr(line, '\n') ? strchr(line, '\n') + 1 : NULL)
		if (!strncmp(line + strspn(line, " \t"), "@include", 8))
			die(path, "@include is not known in a scene");
	return text;
}

void scenefile_read(const char *path, struct scenefile *s)
{
	config_t config;
	int standard = !strcmp(path, "-");
	FILE *f = standard ? stdin : fopen(path, "r");
	if (!f)
		die(path, "cannot open:");
	*s = (struct scenefile){ .up = { 0, 1, 0 } };
	config_init(&config);
	if (standard)
		path = "standard input";
	char *text = whole(path, f);
	if (!config_read_string(&config, text)) {
		const char *what = config_error_text(&config) ? config_error_text(&config) : "cannot be read";
		die(path, "line %d: %s%s", config_error_line(&config), what,
		    strstr(what, "element type") ? " (write 0.0, not 0, beside numbers with a point)" : "");
	}
	fclose(f);
	free(text);
	config_setting_t *root = config_root_setting(&config), *g, *lights;
	only(path, root, "camera medium media lights ground");
	if (!config_setting_get_member(root, "camera"))
		die(path, "needs a group 'camera'");
	camera(path, config_setting_get_member(root, "camera"), s);
	media(path, root, s);

	lights = config_setting_get_member(root, "lights");
	if (!lights)
		s->environment[0] = s->environment[1] = s->environment[2] = 1;
	else if (!config_setting_is_list(lights))
		bad(path, lights, "lights must be a list ( {..}, {..} )");
	for (int i = 0; lights && i < config_setting_length(lights); i++)
		light(path, config_setting_get_elem(lights, (unsigned)i), s);

	g = config_setting_get_member(root, "ground");
	if (g) {
		only(path, g, "height albedo");
		s->has_ground = 1;
		s->ground_height = number(path, g, "height", -1e9, 1e9);
		s->ground_albedo = number(path, g, "albedo", 0, 1);
	}
	config_destroy(&config);
	s->history = canonical(s);
}

void scenefile_free(struct scenefile *s)
{
	for (int i = 0; i < s->n_media; i++)
		free(s->medium[i].file);
	free(s->map.rgb);
	free(s->history);
}
