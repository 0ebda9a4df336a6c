# shellcheck shell=sh
# Media that tests and benchmarks render: particles of one or more classes, Henyey-Greenstein phase functions, the wavelength 0.55 um.
# Sourced with the tools on the PATH and a folder of its own to work in.

# hg G: p(theta) = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos theta)^1.5), at 1801 angles that are densest forward: theta = 180 deg
# (i/1800)^2. As linear between them and normalised by medium-bake, the mean cosine is off by less than 3e-7 for 0 <= g <= 0.9.
hg() { hg_rows "$1" '' | { printf '# wavelength:f64:um\ttheta:f64:deg\tp:f64:sr^-1\n'; cat; } | txttab; }
# hg_rows G RADIUS: its rows, with a column radius if RADIUS is not empty.
hg_rows() {
	awk -v g="$1" -v radius="${2:+	$2}" 'BEGIN {
		pi = atan2(0, -1)
		for (i = 0; i <= 1800; i++) {
			u = (i / 1800)^2
			printf "0.55%s\t%.17g\t%.17g\n", radius, 180 * u, (1 - g*g) / (4 * pi * ((1 - g)^2 + 4 * g * sin(u * pi / 2)^2)^1.5)
		}
	}'
}
# xsections [C_EXT C_SCA].. (um^2): of particles of radius 1000 um, 2000 um, ..
xsections() {
	printf '# wavelength:f64:um\tradius:f64:um\tc_ext:f64:um^2\tc_sca:f64:um^2\n%s\n' \
		"$(echo "$@" | awk '{ for (i = 1; i < NF; i += 2) printf "0.55\t%d\t%s\t%s\n", 500 * (i + 1), $i, $(i + 1) }')" | txttab
}
# sizes N: as many of each of the radii 1000 um, .., N times that
sizes() {
	awk -v n="$1" 'BEGIN { print "# radius:f64:um\tweight:f64:1"; for (i = 1; i <= n; i++) printf "%d\t%.17g\n", 1000 * i, 1 / n }' | txttab
}

# ---- images, which are grey

# mean IMAGE [CHANNEL]: of all pixels.
pixels() { oiiotool "$1" --ch "${2:-G}" --dumpdata | awk '/Pixel/ { print $NF }'; }
mean() { pixels "$@" | awk '{ s += $1 } END { printf "%.9g\n", s / NR }'; }
# both IMAGE IMAGE: of two renderings from different seeds: their mean and its standard error, by the differences of pixels.
both() {
	pixels "$1" >both.1
	pixels "$2" | paste both.1 - | awk '{ s += $1 + $2; d += ($1 - $2)^2 } END { printf "%.9g %.4g\n", s / 2 / NR, sqrt(d) / 2 / NR }'
}

# ---- slabs: by reciprocity, what a camera sees of a wide slab at the cosine mu0 to its normal, under radiance 1 from the upper half
# of all directions, is the share of a beam at mu0 that the slab reflects; under radiance 1 from the lower half, the share it lets
# through.

# slab NAME TAU ALBEDO PHASE: 1 m thick and 10 km wide, the same for --transport continuous and grid
slab() {
	[ -f one.psd ] || sizes 1 >one.psd
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
