/* entry - the OpenCL kernel: work-item k renders the samples [first_sample, first_sample + n_samples) of the pixels
 * [first_pixel + k chunk, first_pixel + (k + 1) chunk), as far as last_pixel. The film begins with pixel film_first. */
__kernel void render(__global const struct scene *scene, __global const float *extinction, __global const float *disc,
                     __global const float *albedo, __global const float *cap, __global const float *colour, __global const int *phase,
                     CHUNK_ARGS(float, interval), CHUNK_ARGS(int, alias), CHUNK_ARGS(int, angle), CHUNK_ARGS(float, particle),
                     CHUNK_ARGS(int, first), CHUNK_ARGS(int, brick), CHUNK_ARGS(float, voxel), CHUNK_ARGS(int, count),
                     CHUNK_ARGS(float, map), CHUNK_ARGS(int, map_cdf), __global int64 *film, __global int *overflow,
                     uint32 film_first, uint32 first_pixel, uint32 last_pixel, uint32 chunk, uint32 first_sample, uint32 n_samples)
{
	struct scene s = *scene;
	struct tables t = { WHOLE_TABLE(extinction), WHOLE_TABLE(disc), WHOLE_TABLE(albedo), WHOLE_TABLE(cap), WHOLE_TABLE(colour), WHOLE_TABLE(phase),
		CHUNK_TABLE(interval), CHUNK_TABLE(alias), CHUNK_TABLE(angle), CHUNK_TABLE(particle), CHUNK_TABLE(first), CHUNK_TABLE(brick),
		CHUNK_TABLE(voxel), CHUNK_TABLE(count), CHUNK_TABLE(map), CHUNK_TABLE(map_cdf) };
	uint32 from = first_pixel + (uint32)get_global_id(0) * chunk, to = min(from + chunk, last_pixel);
	if (from < to)
		render_pixels(&s, &t, film - (int64)s.film_sums * film_first, overflow, from, to, first_sample, first_sample + n_samples);
}
