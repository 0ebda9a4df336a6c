# Renders one of the benchmark's scenes with Mitsuba 3, on one thread, as told line by line on standard input:
#   INTEGRATOR RR_DEPTH SUN_SHARE SAMPLES SEED OUT.pfm      render SAMPLES a pixel to OUT.pfm, R = G = B
# and answers each with "SAMPLES CPU_SECONDS": the samples rendered and the CPU time of rendering alone.
# SAMPLES = "4s" renders for about so many seconds of CPU time. SUN_SHARE 0.5 is Mitsuba's default, which draws the sun or the sky with
# equal chance for next-event estimation; 1 draws the sun alone and leaves the sky to scattered rays, as vrender does.
#
# MEDIUM is lines of "name value", as render.sh writes them: extinction, albedo, phase isotropic | G | TABLE.txt (theta in degrees and p),
# density GRID.npy (none: homogeneous). Camera and lights are those of render.sh's scenes, the medium fills the cube [-1, 1]^3.
# usage: mitsuba3.py VARIANT MEDIUM <jobs;  mitsuba3.py --variants;  mitsuba3.py --version
import sys
import time

import numpy as np
import mitsuba as mi

if sys.argv[1] == '--version':
    print(mi.__version__)
    sys.exit()
if sys.argv[1] == '--variants':     # those without polarisation, spectra and graphics cards, that start
    for variant in 'scalar_mono', 'scalar_rgb', 'llvm_mono', 'llvm_rgb', 'llvm_ad_mono', 'llvm_ad_rgb':
        try:
            mi.set_variant(variant)
            mi.load_dict({'type': 'sphere'})
            print(variant)
        except Exception:
            pass
    sys.exit()

variant, medium = sys.argv[1], dict(line.split() for line in open(sys.argv[2]))
mi.set_variant(variant)
import drjit as dr
dr.set_thread_count(1)
SIDE = 256
# Samples of one call: always so many, to compile only once; so many that what a call costs apart does not tell.
PASS = (2 if 'density' in medium else 16) if 'llvm' in variant else 1

T = mi.ScalarTransform4f()


def phase(what):
    if what == 'isotropic':
        return {'type': 'isotropic'}
    if what.endswith('.txt'):       # linear in theta becomes linear in cos(theta), which runs from -1 to 1; forward is 1
        theta, p = np.loadtxt(what, skiprows=1).T
        cosine = np.linspace(-1, 1, 32769)
        p = np.interp(np.arccos(cosine[::-1]), np.radians(theta), p)[::-1]
        return {'type': 'tabphase', 'values': ','.join('%.9g' % v for v in p)}
    return {'type': 'hg', 'g': float(what)}


def inside():
    inner = {'type': 'homogeneous', 'albedo': float(medium['albedo']), 'phase': phase(medium['phase'])}
    if 'density' in medium:         # both place the voxels' centres at (i + 1/2)/n, trilinear between, constant beyond
        grid = mi.VolumeGrid(np.load(medium['density'])[..., None])
        inner.update(type='heterogeneous', scale=float(medium['extinction']),
                     sigma_t={'type': 'gridvolume', 'grid': grid, 'raw': True, 'filter_type': 'trilinear', 'wrap_mode': 'clamp',
                              'to_world': T.translate([-1, -1, -1]).scale(2)})
    else:
        inner.update(sigma_t=float(medium['extinction']))
    return inner


def scene(integrator, rr_depth, sun_share):
    return mi.load_dict({
        'type': 'scene',
        'integrator': {'type': integrator, 'max_depth': -1, 'rr_depth': rr_depth},
        'sensor': {
            'type': 'perspective', 'fov': 34, 'fov_axis': 'x',
            'to_world': T.look_at(origin=[3.2, 2.4, 4.2], target=[0, 0, 0], up=[0, 1, 0]),
            'film': {'type': 'hdrfilm', 'width': SIDE, 'height': SIDE, 'rfilter': {'type': 'box'}, 'component_format': 'float32',
                     'pixel_format': 'luminance' if 'mono' in variant else 'rgb'},
            'sampler': {'type': 'independent'}},
        'sun': {'type': 'directional', 'direction': [-0.6, -1, -0.3], 'irradiance': float(np.pi), 'sampling_weight': sun_share},
        'sky': {'type': 'constant', 'radiance': 0.2, 'sampling_weight': 1 - sun_share},
        'cube': {'type': 'cube', 'bsdf': {'type': 'null'}, 'interior': inside()}})


def once(it, seed):
    t = time.process_time()
    image = mi.render(it, spp=PASS, seed=seed)
    dr.eval(image)
    dr.sync_thread()
    return np.array(image, dtype=np.float64), time.process_time() - t


scenes = {}
for job in sys.stdin:
    integrator, rr_depth, sun_share, samples, seed, out = job.split()
    key = integrator, int(rr_depth), float(sun_share)
    if key not in scenes:
        scenes[key] = scene(*key)
        once(scenes[key], 2**31)    # compiles
    seconds = float(samples[:-1]) if samples.endswith('s') else 0
    passes = 0 if seconds else max(1, int(samples) // PASS)
    total, cpu, n = 0, 0, 0
    while n < passes or cpu < seconds:
        image, t = once(scenes[key], 10000 * int(seed) + n)
        total, cpu, n = total + image, cpu + t, n + 1
    grey = np.repeat((total / n)[..., -2 if total.shape[-1] == 3 else 0][..., None], 3, axis=2)
    with open(out, 'wb') as file:   # not by Mitsuba, whose OpenEXR waits forever where there is one thread
        file.write(b'PF\n%d %d\n-1.0\n' % (SIDE, SIDE) + grey[::-1].astype('<f4').tobytes())
    print(n * PASS, '%.4f' % cpu, flush=True)
