/* entry - the OpenCL kernel: work-item k renders the samples [first_sample, first_sample + n_samples) of the pixels
 * [first_pixel + k chunk, first_pixel + (k + 1) chunk), as far as last_pixel. The film begins with pixel film_first. */
#if CHUNKS > 1
#error "these kernels want every table in one buffer"
#endif
__kernel void render(__global const struct scene *scene, __global const float *extinction, __global const float *disc,
                     __global const float *albedo, __global const float *colour,
                     __global const int *node, __global const float *theta, __global const float *p, __global const uint32 *cdf,
                     __global const float *particle, __global const uint32 *first, __global const float *voxel,
                     __global const uint32 *count, __global const float *map, __global const uint32 *map_cdf,
                     __global int64 *film, __global int *overflow, uint32 film_first, uint32 first_pixel, uint32 last_pixel,
                     uint32 chunk, uint32 first_sample, uint32 n_samples)
{
	struct scene s = *scene;
	struct tables t = { extinction, disc, albedo, colour, node, theta, p, cdf, particle, first, voxel, count, map,
		map_cdf };
	uint32 pixel = first_pixel + (uint32)get_global_id(0) * chunk;
	for (uint32 k = 0; k < chunk && pixel < last_pixel; k++, pixel++)
		render_pixel(&s, &t, film + (long)s.film_sums * (pixel - film_first), overflow, pixel, first_sample, n_samples);
}
