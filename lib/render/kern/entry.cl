/* entry - the OpenCL kernel: a work-item renders chunk pixels of [first_pixel, last_pixel), LANES paths at a time. */
__kernel void render(__global const struct scene *scene, __global const float *extinction, __global const float *disc,
                     __global const float *albedo, __global const float *colour, __global const int *phase, __global const float *interval,
                     __global const int *alias, __global const int *angle, __global const float *particle, __global const int *first,
                     __global const int *brick, __global const float *voxel, __global const int *count, __global const float *map,
                     __global const int *map_cdf, __global int64 *film, __global int *overflow, uint32 first_pixel, uint32 last_pixel,
                     uint32 chunk, uint32 first_sample, uint32 n_samples)
{
	struct scene s = *scene;
	struct tables t = { extinction, disc, albedo, colour, phase, interval, alias, angle, particle, first, brick, voxel, count, map,
		map_cdf };
	uint32 from = first_pixel + (uint32)get_global_id(0) * chunk, to = min(from + chunk, last_pixel);
	if (from < to)
		render_pixels(&s, &t, film, overflow, from, to, first_sample, first_sample + n_samples);
}
