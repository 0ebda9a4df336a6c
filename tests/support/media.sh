# shellcheck shell=sh
# Media that tests and benchmarks render: particles of one or more classes, Henyey-Greenstein phase functions, the wavelength 0.55 um
# unless told otherwise. Sourced with the tools on the PATH and a folder of its own to work in.

# hg G [WAVELENGTH..]: p(theta) = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos theta)^1.5), at 1801 angles that are densest forward: theta = 180
# deg (i/1800)^2. As linear between them and normalised by medium-bake, the mean cosine is off by less than 3e-7 for 0 <= g <= 0.9.
# g falls by 0.05 from one wavelength to the next.
hg() { { printf '# wavelength:f64:um\ttheta:f64:deg\tp:f64:sr^-1\n'; g=$1; shift; hg_rows "$g" '' "$@"; } | txttab; }
# hg_rows G RADIUS [WAVELENGTH..]: its rows, with a column radius if RADIUS is not empty.
hg_rows() {
	awk -v g="$1" -v radius="${2:+	$2}" -v list="$(shift 2; echo "${*:-0.55}")" 'BEGIN {
		pi = atan2(0, -1)
		n = split(list, wavelength, " ")
		for (l = 1; l <= n; l++) {
			for (i = 0; i <= 1800; i++) {
				u = (i / 1800)^2
				printf "%s%s\t%.17g\t%.17g\n", wavelength[l], radius, 180 * u,
					(1 - g*g) / (4 * pi * ((1 - g)^2 + 4 * g * sin(u * pi / 2)^2)^1.5)
			}
			g -= 0.05
		}
	}'
}
# xsections [C_EXT C_SCA].. (um^2): of particles of radius 1000 um, 2000 um, ..
xsections() {
	printf '# wavelength:f64:um\tradius:f64:um\tc_ext:f64:um^2\tc_sca:f64:um^2\n%s\n' \
		"$(echo "$@" | awk '{ for (i = 1; i < NF; i += 2) printf "0.55\t%d\t%s\t%s\n", 500 * (i + 1), $i, $(i + 1) }')" | txttab
}
# dispersed C_EXT ALBEDO WAVELENGTH..: of particles of radius 1000 um; C_EXT (um^2) grows by a tenth of the first from one to the next.
dispersed() {
	awk -v c="$1" -v a="$2" -v list="$(shift 2; echo "$@")" 'BEGIN {
		print "# wavelength:f64:um\tradius:f64:um\tc_ext:f64:um^2\tc_sca:f64:um^2"
		n = split(list, wavelength, " ")
		for (l = 1; l <= n; l++) { ext = c * (1 + 0.1 * (l - 1)); printf "%s\t1000\t%.10g\t%.10g\n", wavelength[l], ext, ext * a }
	}' | txttab
}
# sizes N: as many of each of the radii 1000 um, .., N times that
sizes() {
	awk -v n="$1" 'BEGIN { print "# radius:f64:um\tweight:f64:1"; for (i = 1; i <= n; i++) printf "%d\t%.17g\n", 1000 * i, 1 / n }' | txttab
}

one_size() { [ -f one.psd ] || sizes 1 >one.psd; }
# cube NAME C_EXT ALBEDO PHASE [WAVELENGTH..]: of side 2 m, 1e6 particles a m3: C_EXT (um^2) of 1e6 is an extinction of 1/m.
cube() (
	one_size
	name=$1 c_ext=$2 albedo=$3 phase=$4
	shift 4
	dispersed "$c_ext" "$albedo" "${@:-0.55}" >cube.xsect
	medium-bake --xsect cube.xsect --phase "$phase" --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m -o "$name"
)
# grains NAME N XSECT PHASE: N particles in a cube of side 2 m, the same for the same N
grains() {
	one_size
	particles --psd one.psd --count "$2" --box 2m,2m,2m | medium-bake --xsect "$3" --phase "$4" --box 2m,2m,2m -o "$1"
}

# ---- slabs: by reciprocity, what a camera sees of a wide slab at the cosine mu0 to its normal, under radiance 1 from the upper half
# of all directions, is the share of a beam at mu0 that the slab reflects; under radiance 1 from the lower half, the share it lets
# through.

# slab NAME TAU ALBEDO PHASE: 1 m thick and 10 km wide, the same for --transport continuous and grid
slab() {
	one_size
	xsections "$(awk -v t="$2" -v a="$3" 'BEGIN { printf "%.17g %.17g", t * 1e6, t * 1e6 * a }')" >slab.xsect
	medium-bake --xsect slab.xsect --phase "$4" --psd one.psd --concentration 1e6/m3 --box 1e4m,1m,1e4m --voxels 4 -o "$1"
}
# look NAME MEDIUM MU0 LIGHTS: a scene all of whose 32 x 32 pixels see the middle of the slab at the cosine MU0
look() {
	awk -v file="$2" -v mu="$3" -v lights="$4" 'BEGIN {
		printf "camera = { position = [%.9f, %.9f, 0.0]; target = [0.0, 0.5, 0.0]; up = [0.0, 0.0, 1.0]; fov = 0.001; resolution = [32, 32]; };\n",
			2 * sqrt(1 - mu * mu), 0.5 + 2 * mu
		printf "medium = { file = \"%s\"; };\nlights = ( %s );\n", file, lights
	}' >"$1"
}
half_sky() { echo "{ type = \"sun\"; direction = [0.0, $1.0, 0.0]; irradiance = 3.14159265358979; angle = 180.0; }"; }
# beam MU0 IRRADIANCE: parallel light downwards at the cosine MU0 (upwards where it is negative), in the plane of the camera
beam() {
	awk -v mu="$1" -v e="$2" 'BEGIN { printf "{ type = \"sun\"; direction = [%.9f, %.9f, 0.0]; irradiance = %.9f; }", sqrt(1 - mu * mu), -mu, e }'
}
# seen SCENE ERROR SEED [OPTION..]: the mean radiance, its standard error, the number of samples. Two renderings from the seeds SEED
# and SEED + 1, so long that the standard error is about ERROR, as two short ones from other seeds tell. It is that of the
# differences of pixels. Takes the folder's black.exr, made here.
seen() {
	scene=$1 error=$2 seed=$3
	shift 3
	if ! [ -f black.exr ]; then
		sed '/^lights/s/.*/lights = ( );/' "$scene" >black.scene
		vrender black.scene --samples 1 -o black.exr
	fi
	vrender "$scene" --samples 16 --seed $((seed + 1000000)) "$@" -o a.exr
	vrender "$scene" --samples 16 --seed $((seed + 1000001)) "$@" -o b.exr
	samples=$(imgcmp --channels G --block 32 --rms 9 a.exr b.exr | awk -v e="$error" '$1 == "G" {
		n = 1.1 * $2 * $2 / 4 * 16 / 1024 / e / e
		printf "%d\n", n < 64 ? 64 : n + 1 }')
	vrender "$scene" --samples "$samples" --seed "$seed" "$@" -o a.exr
	vrender "$scene" --samples "$samples" --seed $((seed + 1)) "$@" -o b.exr
	# the mean of the only block, from black, is that of the image
	for pair in 'a.exr black.exr' 'b.exr black.exr' 'a.exr b.exr'; do
		# shellcheck disable=SC2086
		imgcmp --channels G --block 32 --rms 9 $pair
	done | awk -v n="$samples" '$1 == "G" { rms[++i] = $2; mean[i] = $6 }
		END { printf "%.7g %.3g %d\n", (mean[1] + mean[2]) / 2, rms[3] / 2 / 32, 2048 * n }'
}

# ---- judging: a table of what, wanted, got, standard error of what was got

# zs WORST [LOW HIGH]: reads such lines, tab-separated; prints how many, the rms of z = (got - wanted)/error and the worst of them;
# fails where |z| > WORST or the rms is outside [LOW, HIGH], or, with one value in place of both, outside what chance leaves of 1:
# the rms of n normal values is in sqrt((1 - 2/(9n) -+ Z sqrt(2/(9n)))^3) but for the tails beyond Z standard deviations (Wilson and
# Hilferty).
zs() {
	awk -F'\t' -v worst="$1" -v low="$2" -v high="${3:-}" '
		{ z = $4 > 0 ? ($3 - $2) / $4 : 1e9; n++; s += z * z; if (z * z > most * most || n == 1) { most = z; what = $1 } }
		END {
			if (high == "") {
				v = 2 / 9 / n; Z = low; low = 1 - v - Z * sqrt(v); low = low > 0 ? sqrt(low^3) : 0; high = sqrt((1 - v + Z * sqrt(v))^3)
			}
			rms = sqrt(s / n)
			printf "%d values, z rms %.3f (of %.3f to %.3f), worst %.2f: %s\n", n, rms, low, high, most, what
			exit !(n && rms >= low && rms <= high && most <= worst && most >= -worst)
		}'
}

# ---- clouds of ever more and ever smaller particles, in a cube of side 2 m, optical depth 2 across, albedo 0.9, g 0.5, before
# a sun of 40 degrees and radiance 2.72; what is not scattered and what is, once and more often, make up the picture.
# A camera at 9 m from the face sees its middle 1.5 m; a pixel there is (23.4 mm)^2, A = 5.47e-4 m2, what a fat ray covers where that
# is more than a particle's C = 8 m2/N.

clouds_setup() {
	one_size
	hg 0.5 >grains.phase
	cat >grains.scene <<-'EOT'
	camera = { position = [0.0, 0.0, 10.0]; target = [0.0, 0.0, 0.0]; fov = 9.5; resolution = [64, 64]; };
	medium = { file = "grains.medium"; };
	lights = ( { type = "sun"; direction = [0.0, 0.0, 1.0]; irradiance = 1.0; angle = 40.0; } );
	EOT
}
# cloud N SEED: grains.medium
cloud() {
	xsections "$(awk -v n="$1" 'BEGIN { printf "%.17g %.17g", 8e12 / n, 0.9 * 8e12 / n }')" >grains.xsect
	particles --psd one.psd --count "$1" --box 2m,2m,2m --seed "$2" |
		medium-bake --xsect grains.xsect --phase grains.phase --box 2m,2m,2m -o grains.medium
}
# continuum SAMPLES: continuous.1.exr and .2.exr, what the clouds come to, from two seeds; black.exr
continuum() {
	cloud 100 1
	for s in 1 2; do vrender grains.scene --transport continuous --samples "$1" --seed 200000$s -o continuous.$s.exr; done
	sed '/^lights/s/.*/lights = ( );/' grains.scene >black.scene
	vrender black.scene --transport continuous --samples 1 -o black.exr
}
# block_rms N CHANNEL..: what imgcmp says of two images; with N = 64 and black.exr the mean of one
block_rms() { imgcmp --channels G --rms 99 --block "$1" "$2" "$3" | awk '$1 == "G" { print $5 }'; }
# departs N TRANSPORT SAMPLES SEEDS: for each seed of the particles a line: N, transport, the mean square over blocks of 8 x 8 pixels of
# the difference from the continuum, the mean of the image. With a and b from two seeds of one cloud, c and d the continuum from two
# seeds, (a - c)(b - d) = ((a - d)^2 + (b - c)^2 - (a - b)^2 - (c - d)^2)/2 has no Monte Carlo variance in its mean.
departs() {
	for seed in $(seq "$4"); do
		cloud "$1" "$seed"
		for s in 1 2; do
			vrender grains.scene --transport "$2" --samples "$3" --seed $((2 * seed + s)) -o grains.$s.exr
		done
		for pair in 'grains.1 continuous.2' 'grains.2 continuous.1' 'grains.1 grains.2' 'continuous.1 continuous.2'; do
			block_rms 8 "${pair% *}.exr" "${pair#* }.exr"
		done >squares
		for s in 1 2; do block_rms 64 grains.$s.exr black.exr; done | cat squares - | awk -v n="$1" -v t="$2" '{ x[NR] = $1 }
			END { printf "%s %s %.8g %.8g\n", n, t, (x[1]^2 + x[2]^2 - x[3]^2 - x[4]^2) / 2, (x[5] + x[6]) / 2 }'
	done
}
# limit: the mean of the continuum and its standard error
limit() {
	for s in 1 2; do block_rms 64 continuous.$s.exr black.exr; done | paste -s - |
		awk -v r="$(imgcmp --channels G --rms 99 continuous.1.exr continuous.2.exr | awk '$1 == "G" { print $2 }')" \
			'{ printf "%.8g %.4g\n", ($1 + $2) / 2, r / 2 / 64 }'
}
# law LIMIT ERROR: reads lines of departs; prints a line for each transport and N: transport, N, A/C, clouds, rms of the blocks, the mean, its
# standard error from the spread over clouds, and the same in standard errors from LIMIT (its own ERROR taken in); then for each transport
# "slope", its name, the slope of log rms by log N, and the largest mean deviation, in standard errors pooled over N as N^(-1/2).
law() {
	sort -k 2,2 -k 1,1g -s | awk -v OFS='\t' -v limit="$1" -v error="$2" '
		function count(    v) {
			if (!n) return
			s /= n; m /= n
			v = (mm - n * m * m) / (n - 1)
			rms = s > 0 ? sqrt(s) : 1e-9
			a = t == "fat-ray" ? 5.466e-4 * N / 8 : 1
			print t, N, sprintf("%.4g", a > 1 ? a : 1), n, sprintf("%.5g", rms), sprintf("%.6f", m), sprintf("%.2g", sqrt(v / n)),
				sprintf("%.2f", (m - limit) / sqrt(v / n + error * error))
			k++; x = log(N); y = log(rms)
			sx += x; sy += y; sxx += x * x; sxy += x * y
			number[k] = N; mean[k] = m; pooled += v * N; clouds = n
			s = m = mm = n = 0
		}
		function transport(    i, z, most) {
			count()
			if (!k) return
			for (i = 1; i <= k; i++) {
				z = (mean[i] - limit) / sqrt(pooled / k / number[i] / clouds + error * error)
				if (z * z > most * most) most = z
			}
			print "slope", t, sprintf("%.4f", (k * sxy - sx * sy) / (k * sxx - sx * sx)), sprintf("%.2f", most)
			k = sx = sy = sxx = sxy = pooled = 0
		}
		$2 != t { transport(); N = "" }
		$1 != N { count() }
		{ N = $1; t = $2; n++; s += $3; m += $4; mm += $4 * $4 }
		END { transport() }'
}

# ---- noise: an image rendered from two seeds, NAME.1.exr and NAME.2.exr, knows the spread of its blocks by the differences of pixels

# twice NAME SCENE SEED [OPTION..]: from SEED and SEED + 1
twice() {
	name=$1 scene=$2 seed=$3
	shift 3
	for s in 1 2; do vrender "$scene" --seed $((seed + s - 1)) "$@" -o "$name.$s.exr"; done
}
# blocks NAME CHANNEL: for each block of 8 x 8 pixels the mean and its variance
blocks() { block_means "$1.1.exr" "$1.2.exr" "$2"; }
# against NAME FILE..: lines for zs: the blocks of the first FILE against the sums of those of the others; then their sum as "whole"
against() {
	name=$1
	shift
	paste "$@" | awk -v OFS='\t' -v name="$name" '{
		w = 0; v = $2
		for (i = 3; i < NF; i += 2) { w += $i; v += $(i + 1) }
		print name " " NR, w, $1, sqrt(v)
		ws += w; gs += $1; vs += v
	} END { print "whole", ws / NR, gs / NR, sqrt(vs) / NR }'
}
