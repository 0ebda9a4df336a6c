/* entry - the OpenCL kernel: one work-item a pixel of [0, n_pixels). */
__kernel void render(__global const struct scene *scene, __global const float *extinction, __global const float *disc,
                     __global const float *albedo, __global const float *colour,
                     __global const int *node, __global const float *theta, __global const float *p, __global const uint32 *cdf,
                     __global const float *particle, __global const uint32 *first, __global const float *voxel,
                     __global const uint32 *count, __global const float *map, __global const uint32 *map_cdf,
                     __global int64 *film, __global int *overflow, uint32 n_pixels, uint32 first_sample, uint32 n_samples)
{
	struct scene s = *scene;
	struct tables t = { extinction, disc, albedo, colour, node, theta, p, cdf, particle, first, voxel, count, map,
		map_cdf };
	uint32 pixel = (uint32)get_global_id(0);
	if (pixel < n_pixels)
		render_pixel(&s, &t, film + (long)s.film_sums * pixel, overflow, pixel, first_sample, n_samples);
}
