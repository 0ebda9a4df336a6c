# shellcheck shell=sh
# What the tests of the renderer share beside media.sh: scenes, and statistics of pictures. Sourced after lib.sh.
# shellcheck disable=SC2154
# shellcheck source=tests/support/media.sh
. "$top/tests/support/media.sh"

scene() { # scene NAME MEDIUM PIXELS MORE
	cat >"$1" <<-EOT
	camera = { position = [3.2, 2.4, 4.2]; target = [0.0, 0.0, 0.0]; fov = 34.0; resolution = [$3, $3]; };
	medium = { file = "$2"; };
	$4
	EOT
}
stats() { oiiotool --stats "$1" | awk -v what="$2" '$1 == "Stats" && $2 == what":" { print $3, $4, $5 }'; }
mean() { stats "$1" Avg | awk '{ print $1 }'; }
near() { awk -v a="$1" -v b="$2" -v e="$3" 'BEGIN { d = a - b; exit !(a ~ /[0-9]/ && d <= e && d >= -e) }'; }
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
		for cpu in $(cpus); do
			MOTES_CPU=$cpu vrender "$scene" "$@" --samples "$samples" --transport $t -o one_cpu.exr && cmp one.exr one_cpu.exr || differ="$differ $cpu"
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
