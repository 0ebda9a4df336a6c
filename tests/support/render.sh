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
near() { awk -v a="$1" -v b="$2" -v e="$3" 'BEGIN { d = a - b; exit !(a ~ /[0-9]/ && d <= e && d >= -e) }'; }
# agree NAME WANT ITS_ERROR LARGEST A B [CHANNEL]: the mean of two renderings of the same length from different seeds is WANT within 4
# standard errors (false alarm 6e-5); their own difference gives the standard error, which must not be above LARGEST.
agree() {
	awk -v sum="$(channels mean "$5" "${7:-G}" + "$6" "${7:-G}")" -v error="$(channels error "$5" "${7:-G}" - "$6" "${7:-G}")" -v w="$2" -v e="$3" -v most="$4" 'BEGIN {
		m = sum / 2; s = error / 2; d = m - w
		printf "%.6f, wanted %s +- %s, standard error %.3g", m, w, e, s
		exit !(sum error ~ /[0-9]/ && d * d <= 16 * (s * s) + e * e && s <= most && s > 0) }' >told
	ok $? "$1: $(cat told)"
}
# simulated NAME TINY [OPTION..]: two tests of a scene small enough for a simulator of OpenCL, which tells of what a kernel must not do.
# By the ordinary build, since a sanitizer does not go with its libraries; FN=static, since inlining leaves intrinsics that it does not know.
simulated() {
	name=$1
	shift
	vrender "$@" --samples 1 -o one.exr
	PATH=$top/build/bin:$PATH oclgrind --check-api --build-options '-DFN=static -cl-opt-disable' \
		vrender "$@" --samples 1 --backend opencl -o grind.exr 2>grind.err
	is "0 0" "$? $(grep -vc 'the device rounds otherwise' grind.err)" "$name: oclgrind finds nothing wrong"
	cmp one.exr grind.exr
	ok $? "$name: and gives the same bytes"
}
# every_way NAME SCENE SAMPLES [OPTION..]: three tests of the bytes of NAME.exr, which it makes.
every_way() {
	name=$1 scene=$2 samples=$3
	shift 3
	set -- "$scene" "$@" --samples "$samples"
	vrender "$@" --threads 1 -o "$name.exr"
	vrender "$@" --threads 2 -o two.exr
	cmp "$name.exr" two.exr
	ok $? "$name: two threads give the bytes of one"
	differ=
	for cpu in $(cpus); do
		MOTES_CPU=$cpu vrender "$@" -o cpu.exr && cmp "$name.exr" cpu.exr || differ="$differ $cpu"
	done
	is '' "$differ" "$name: so do kernels in lanes of any width"
	vrender "$@" --backend opencl -o cl.exr
	cmp "$name.exr" cl.exr
	ok $? "$name: OpenCL gives the bytes of C"
}
# same_bytes SCENE SAMPLES TINY [OPTION..]: five tests a transport, of a scene and of another that is small enough for the simulator; and one
# of all.
same_bytes() {
	whole=$1 many=$2 tiny=$3
	shift 3
	for t in explicit fat-ray grid continuous; do
		every_way $t "$whole" "$many" "$@" --transport $t
		simulated $t "$tiny" "$@" --transport $t
	done
	is 4 "$(oiiotool --stats explicit.exr fat-ray.exr grid.exr continuous.exr | grep -c 'Stats NanCount: 0 0 0')" 'an independent reader finds no NaN in any'
}
# same_picture A B: of A.1.exr and .2.exr, and of B's, the blocks of five channels differ by their noise: the rms of z beyond 4 standard
# deviations of it is chance for 6 in 10^5 channels, |z| of 65 values above 5 for 4 in 10^5.
same_picture() {
	for c in R G B single.R multiple.B; do
		blocks "$1" $c >wanted.blocks
		blocks "$2" $c >got.blocks
		against "$c" got.blocks wanted.blocks | zs 5 4 >told
		ok $? "$1 and $2, $c: $(cat told)"
	done
}
