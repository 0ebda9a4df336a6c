# shellcheck shell=sh
# What the tests of the renderer share: media, scenes, and statistics of pictures. Sourced after lib.sh.
# shellcheck disable=SC2154
export POCL_CACHE_DIR="$tmp/pocl"
mkdir "$POCL_CACHE_DIR"

# hg G WAVELENGTH..: Henyey-Greenstein phase functions, one a wavelength, g falling by 0.05 from one to the next.
hg() {
	g=$1
	shift
	awk -v g="$g" -v list="$*" 'BEGIN {
		print "# wavelength:f64:um\ttheta:f64:deg\tp:f64:sr^-1"
		n = split(list, w, " "); pi = atan2(0, -1)
		for (l = 1; l <= n; l++) {
			a = g - 0.05 * (l - 1)
			for (i = 0; i <= 1800; i++)
				printf "%s\t%.10g\t%.10g\n", w[l], i / 10, (1 - a*a) / (4*pi * (1 + a*a - 2*a*cos(i * pi / 1800))^1.5)
		}
	}' | txttab
}
# xsect C_EXT ALBEDO WAVELENGTH..: of particles of radius 1000 um.
xsections() {
	c=$1 a=$2
	shift 2
	{ printf '# wavelength:f64:um\tradius:f64:um\tc_ext:f64:um^2\tc_sca:f64:um^2\n'
	for w; do awk -v w="$w" -v c="$c" -v a="$a" 'BEGIN { printf "%s\t1000\t%.10g\t%.10g\n", w, c, c * a; exit }'; c=$((c + 100000)); done
	} | txttab
}
printf '# radius:f64:um\tweight:f64:1\n1000\t1\n' | txttab -o one.psd
# cube NAME EXTINCTION_IN_1E-6_UM2 ALBEDO PHASE: a cube of side 2 m, 1e6 particles a m3, one wavelength
cube() {
	xsections "$2" "$3" 0.55 >one.xsect
	medium-bake --xsect one.xsect --phase "$4" --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m -o "$1"
}
# grains NAME N XSECT PHASE: N particles in a cube of side 2 m
grains() {
	particles --psd one.psd --count "$2" --box 2m,2m,2m | medium-bake --xsect "$3" --phase "$4" --box 2m,2m,2m -o "$1"
}
scene() { # scene NAME MEDIUM PIXELS MORE
	cat >"$1" <<-EOT
	camera = { position = [3.2, 2.4, 4.2]; target = [0.0, 0.0, 0.0]; fov = 34.0; resolution = [$3, $3]; };
	medium = { file = "$2"; };
	$4
	EOT
}
stats() { oiiotool --stats "$1" | awk -v what="$2" '$1 == "Stats" && $2 == what":" { print $3, $4, $5 }'; }
mean() { stats "$1" Avg | awk '{ print $1 }'; }
near() { awk -v a="$1" -v b="$2" -v e="$3" 'BEGIN { d = a - b; exit !(d <= e && d >= -e) }'; }
# agree NAME WANT ITS_ERROR LARGEST A B: the mean of two renderings of the same length from different seeds is WANT within 4
# standard errors (false alarm 6e-5); their own difference gives the standard error, which must not be above LARGEST.
agree() {
	imgcmp "$5" "$6" >diff.txt
	rms=$(awk '$1 == "G" { print $2 }' diff.txt)
	pixels=$(oiiotool --info "$5" | sed 's/^[^:]*: *\([0-9]*\) x *\([0-9]*\),.*/\1*\2/' | awk -F'*' '{ print $1 * $2 }')
	m=$(awk -v a="$(mean "$5")" -v b="$(mean "$6")" 'BEGIN { print (a + b) / 2 }')
	se=$(awk -v r="$rms" -v n="$pixels" 'BEGIN { print r / 2 / sqrt(n) }')
	awk -v m="$m" -v w="$2" -v s="$se" -v e="$3" -v most="$4" \
		'BEGIN { d = m - w; exit !(d * d <= 16 * (s * s) + e * e && s <= most && s > 0) }'
	ok $? "$1: $m, wanted $2 +- $3, standard error $se"
}
# same_bytes SCENE SAMPLES TINY [OPTION..]: six tests a transport, of a scene and of a picture of it small enough for the simulator.
same_bytes() {
	scene=$1 samples=$2 tiny=$3
	shift 3
	for t in explicit fat-ray grid continuous; do
		vrender "$scene" "$@" --samples "$samples" --transport $t --threads 1 -o one.exr
		vrender "$scene" "$@" --samples "$samples" --transport $t --threads 2 -o two.exr
		cmp one.exr two.exr
		ok $? "$t: two threads give the bytes of one"
		differ=
		for cpu in scalar v2 v3 v4; do    # those that the processor has
			MOTES_CPU=$cpu vrender "$scene" "$@" --samples "$samples" --transport $t -o one_cpu.exr 2>cpu.err && cmp one.exr one_cpu.exr && continue
			grep -q 'this processor is no' cpu.err || differ=yes
		done
		is '' "$differ" "$t: so do kernels in lanes of any width"
		vrender "$scene" "$@" --samples "$samples" --transport $t --backend opencl -o cl.exr
		cmp one.exr cl.exr
		ok $? "$t: OpenCL gives the bytes of C"
		oiiotool --stats one.exr | grep -q 'Stats NanCount: 0 0 0'
		ok $? "$t: an independent reader finds no NaN"
		vrender "$tiny" "$@" --samples 1 --transport $t -o one.exr
		# the ordinary build, since a sanitizer does not go with the simulator's libraries; FN=static, since inlining leaves
		# intrinsics that the simulator does not know
		PATH=$top/build/bin:$PATH oclgrind --check-api --build-options '-DFN=static -cl-opt-disable' \
			vrender "$tiny" "$@" --samples 1 --transport $t --backend opencl -o grind.exr 2>grind.err
		is "0 0" "$? $(grep -vc 'the device rounds otherwise' grind.err)" "$t: oclgrind finds nothing wrong"
		cmp one.exr grind.exr
		ok $? "$t: and gives the same bytes"
	done
}
