/* entry - the OpenCL kernel: work-item k renders the samples [first_sample, first_sample + n_samples) of the pixels
 * [first_pixel + k chunk, first_pixel + (k + 1) chunk), as far as last_pixel. The film begins with pixel film_first. */
#define TABLE_ARG(type, name) __global const type *name,
#define TABLE_ARGS(type, name) CHUNK_ARGS(type, name),
#define TABLE_WHOLE(type, name) WHOLE_TABLE(name, s.volume[k].at.name),
#define TABLE_CHUNKS(type, name) CHUNK_TABLE(name, s.volume[k].at.name),

__kernel void render(__global const struct scene *scene, TABLES(TABLE_ARG, TABLE_ARGS) __global int64 *film, __global int *overflow,
                     uint32 film_first, uint32 first_pixel, uint32 last_pixel, uint32 chunk, uint32 first_sample, uint32 n_samples)
{
	struct scene s = *scene;
	struct tables t[N_VOLUMES];
	uint32 from = first_pixel + (uint32)get_global_id(0) * chunk, to = min(from + chunk, last_pixel);
	EACH(k, N_VOLUMES) {
		const struct tables own = { TABLES(TABLE_WHOLE, TABLE_CHUNKS) };
		t[k] = own;
	}
	if (from < to)
		render_pixels(&s, t, film - (int64)s.film_sums * film_first, overflow, from, to, first_sample, first_sample + n_samples);
}
