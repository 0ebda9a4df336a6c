#!/bin/sh
# The renderer: bookkeeping (furnace), known radiances, and the same bytes from every way to run it.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/render.sh
. "$top/tests/support/render.sh"
hg 0 0.55 >iso.phase
hg 0.8 0.55 >hg.phase
hg 0.8 0.45 0.55 0.65 >hg3.phase

# ---- furnace: albedo 1, radiance 1 all around: every pixel is 1, whatever happens inside

cube white.medium 4000000 1 hg.phase
dispersed 1000000000 1 0.55 >big.xsect
grains white-grains.medium 3e4 big.xsect hg.phase
for t in explicit fat-ray grid continuous; do
	scene furnace.scene white-grains.medium 48 ''
	vrender furnace.scene --samples 16 --transport $t -o f.exr
	low=$(channels min f.exr G) high=$(channels max f.exr G)
	near "$low" 1 1e-5 && near "$high" 1 1e-5
	ok $? "furnace, $t: pixels from $low to $high"
	scene furnace.scene white-grains.medium 48 'ground = { height = -0.9; albedo = 1.0; };'
	vrender furnace.scene --samples 16 --transport $t -o f.exr
	low=$(channels min f.exr G) high=$(channels max f.exr G)
	near "$low" 1 1e-5 && near "$high" 1 1e-5
	ok $? "furnace on white ground, $t: pixels from $low to $high"
	# the same radiance as two suns that are half the sky each: drawn and met, weighed by multiple importance sampling; standard errors
	# of up to 2e-4, so that light lost or made by more than 1.2e-3 is found but for 1 in 100
	scene suns.scene white-grains.medium 48 'lights = ( { type = "sun"; direction = [0.0, -1.0, 0.2]; irradiance = 3.14159265358979; angle = 180.0; },
		{ type = "sun"; direction = [0.0, 1.0, -0.2]; irradiance = 3.14159265358979; angle = 180.0; } );'
	vrender suns.scene --samples 900 --seed 1 --transport $t -o a.exr
	vrender suns.scene --samples 900 --seed 2 --transport $t -o b.exr
	agree "furnace of two hemispherical suns, $t" 1 0 2e-4 a.exr b.exr
done

# ---- known radiances: two independent programs agree on them

cube cube.medium 4000000 0.99 iso.phase
lights='lights = ( { type = "environment"; radiance = 0.2; }, { type = "sun"; direction = [-0.6, -1.0, -0.3]; irradiance = 3.14159265; } );'
scene cube.scene cube.medium 128 "$lights"
for s in 1 2; do vrender cube.scene --samples 256 --seed $s -o cube$s.exr; done
agree 'cube of extinction 4, albedo 0.99, isotropic' 0.36437 0.00006 2e-4 cube1.exr cube2.exr

# their table of Deirmendjian's C1 has 32,769 nodes, even in the cosine, and is linear in it; the first ones, which are far apart in
# theta, have steps between them here
psd gamma --effective-radius 6um --effective-variance 0.11111111111 --min 0.4um --max 16um --classes 160 |
	mie-phase --particle 1.333 --wavelength 550nm --average --angles 36001 --threads 2 | tabtxt --columns theta,p | awk '
	NR == 1 { print "# wavelength:f64:um\ttheta:f64:deg\tp:f64:sr^-1"; next }
	{ p[n++] = $2 }
	function at(c,  t, i) {
		t = atan2(sqrt((1 - c) * (1 + c)), c) * 180 / pi * 200
		i = t < n - 1 ? int(t) : n - 2
		return p[i] + (p[i + 1] - p[i]) * (t - i)
	}
	function row(c, q) { printf "0.55\t%.17g\t%.10g\n", atan2(sqrt((1 - c) * (1 + c)), c) * 180 / pi, q }
	BEGIN { pi = atan2(0, -1) }
	END {
		for (k = 0; k < 32768; k++) {
			a = at(c0 = 1 - k / 16384)
			b = at(c1 = 1 - (k + 1) / 16384)
			m = k < 200 ? 16 : 1
			for (j = 0; j < m; j++)
				row(c0 + (c1 - c0) * j / m, a + (b - a) * j / m)
		}
		row(-1, b)
	}' | txttab -o c1.phase
cube c1.medium 6000000 0.999 c1.phase
scene c1.scene c1.medium 128 "$lights"
# standard errors of about 1e-4, a third of what the reference is known to
for s in 1 2; do vrender c1.scene --samples 300 --seed $s -o c1$s.exr; done
agree 'cube of extinction 6, albedo 0.999, Deirmendjian C1' 0.2837 0.0003 1.5e-4 c11.exr c12.exr

# ---- Beer and Lambert: black particles, seen against radiance 1 through the middle of the cube (optical depth 2)

cube black.medium 1000000 0 iso.phase
dispersed 2666667 0 0.55 >small.xsect
grains black-grains.medium 3e6 small.xsect iso.phase
beer='camera = { position = [0.0, 0.0, 1000.0]; target = [0.0, 0.0, 0.0]; fov = 0.1; resolution = [64, 64]; };'
for t in continuous explicit; do
	[ $t = explicit ] && medium=black-grains.medium || medium=black.medium
	echo "$beer medium = { file = \"$medium\"; };" >beer.scene
	vrender beer.scene --samples 128 --transport $t -o beer.exr
	# 64^2 x 128 paths that get through or not: standard error 4.7e-4; that of the particles' own chance, 3.1e-4, is in the same
	# places for all of them. Seven of both: false alarm below 1e-11.
	mean=$(channels mean beer.exr G)
	near "$mean" 0.1353353 0.004
	ok $? "Beer and Lambert, $t: $mean"
done

# ---- the same bytes: threads, backends, both transports, three wavelengths, groups of wavelengths

dispersed 90000000 0.97 0.45 0.55 0.65 >three.xsect
grains three.medium 3000 three.xsect hg3.phase
full='lights = ( { type = "environment"; radiance = 0.3; }, { type = "sun"; direction = [-0.6, -1.0, -0.3]; irradiance = 2.0; angle = 10.0; },
	{ type = "sun"; direction = [1, -1, 0]; irradiance = 1; } ); ground = { height = -1.2; albedo = 0.4; };'
scene three.scene three.medium 32 "$full"
dispersed 10000000000 0.97 0.45 0.55 0.65 >tiny.xsect
grains tiny.medium 300 tiny.xsect hg3.phase
scene tiny.scene tiny.medium 4 "$full"
same_bytes three.scene 8 tiny.scene
hg 0.7 0.40 0.42 0.44 0.46 0.48 0.50 0.52 0.54 0.56 0.58 0.60 >many.phase
dispersed 3000000 0.9 0.40 0.42 0.44 0.46 0.48 0.50 0.52 0.54 0.56 0.58 0.60 >many.xsect
medium-bake --xsect many.xsect --phase many.phase --psd one.psd --concentration 1e6/m3 --sphere 1m -o many.medium
scene many.scene many.medium 32 ''
vrender many.scene --samples 64 -o many.exr
vrender many.scene --samples 64 --backend opencl -o manycl.exr
cmp many.exr manycl.exr
ok $? 'eleven wavelengths go in two groups, the same in OpenCL'
exr2png many.exr -o many.png
oiiotool --stats many.png >/dev/null
ok $? 'an independent reader takes our PNG'

# ---- progress only on a terminal, bad input in one line

vrender many.scene --samples 1 -o x.exr 2>err
is '' "$(cat err)" 'no progress where stderr is no terminal'
scene typo.scene white.medium 8 'lihgts = ( );'
refused 'a misspelt key' "typo.scene: line 3: unknown key 'lihgts'" vrender typo.scene -o typo.exr
scene bad.scene white.medium 8 'ground = { height = "low"; albedo = 0.5; };'
refused 'a value of the wrong type' 'line 3: ground.height must be a number' vrender bad.scene -o typo.exr
scene bad.scene nowhere.medium 8 ''
refused 'a medium that is not there' 'nowhere.medium: cannot open' vrender bad.scene -o typo.exr
scene white.scene white.medium 8 ''
refused 'explicit needs particles' 'has no particles' vrender white.scene --transport explicit -o typo.exr
scene hot.scene white.medium 8 'lights = ( { type = "environment"; radiance = 1e9; } );'
refused 'light beyond what the film can hold' 'too strong' vrender hot.scene --samples 64 -o typo.exr
refused 'a device that is not there' 'none of the' vrender white.scene --backend opencl --device 60 -o typo.exr
is '' "$(ls typo.exr* 2>/dev/null)" 'no image appears under its name'
done_testing
