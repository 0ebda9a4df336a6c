# shellcheck shell=sh
# What lanes are worth: the speed of each code path of the C backend (MOTES_CPU) over that of its scalar path, one thread, CPU time, for
# the four transports; of OpenCL over C, two threads each, by the clock; and how long OpenCL takes to compile, and to start when it has.
# Media: continuous in a homogeneous cube, grid in a density grid of 128^3, explicit and fat-ray in 10^5 particles of optical depth 2;
# the sun and the camera of render.sh.
# Prints lanes.tsv and lines PASS or FAIL. Required: v4 at least 6, 3, 2, 2, v3 at least 3, 1.5, 1.2, 1.2 times scalar; OpenCL at least 0.8
# of C; compiling below 10 s, a start from the cache below 0.5 s.
# usage, by tests/bench/run: [BENCH_SECONDS=3] lanes.sh OUT
out=$1
bench=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/support/media.sh
. "$bench/../support/media.sh"
# shellcheck source=tests/bench/timing
. "$bench/timing"
seconds=${BENCH_SECONDS:-3}
export POCL_MAX_PTHREAD_COUNT=2

sizes 1 >one.psd
hg 0 >0.phase
hg 0.85 >0.85.phase
perl "$bench/density.pl" cloud >cloud.npy
xsections 4e6 3.96e6 >c.xsect
medium-bake --xsect c.xsect --phase 0.phase --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m -o continuous.medium
xsections 3e7 2.997e7 >c.xsect
medium-bake --xsect c.xsect --phase 0.85.phase --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m --density cloud.npy -o grid.medium
xsections 8e7 7.2e7 >c.xsect      # N C = 8 m2 in 8 m3, as in media.sh
particles --psd one.psd --count 1e5 --box 2m,2m,2m | medium-bake --xsect c.xsect --phase 0.85.phase --box 2m,2m,2m -o explicit.medium
cp explicit.medium fat-ray.medium
transports='continuous grid explicit fat-ray'
for t in $transports; do view "$t" 256; done

failed=0
# need WHAT GOT LIMIT UNIT: at least LIMIT; at most, where LIMIT begins with -
need() {
	awk -v what="$1" -v got="$2" -v limit="$3" -v unit="$4" 'BEGIN {
		ok = limit > 0 ? got >= limit : got <= -limit
		print (ok ? "PASS" : "FAIL") " " what ": " got unit ", required at " (limit > 0 ? "least " limit : "most " -limit) unit
		exit !ok }' || failed=1
}
# ratio A B
ratio() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.3g\n", a / b }'; }

printf '# transport\twhat\tsamples\ts\tspeed, as a ratio\tto\n' >lanes.tsv
{
	need 'OpenCL, compiling and one sample' "$(wall vrender continuous.scene --backend opencl --samples 1 -o cl.exr)" -10 ' s'
	view start 8
	cp continuous.medium start.medium
	vrender start.scene --backend opencl --samples 1 -o cl.exr
	need 'OpenCL, start from the cache' "$(wall vrender start.scene --backend opencl --samples 1 -o cl.exr)" -0.5 ' s'
	for t in $transports; do
		case $t in continuous) v3=3 v4=6 ;; grid) v3=1.5 v4=3 ;; *) v3=1.2 v4=2 ;; esac
		scalar=
		for path in scalar v2 v3 v4; do
			MOTES_CPU=$path
			export MOTES_CPU
			n=$(samples_for "$seconds" vrender "$t.scene" --transport "$t") || { echo "not here: MOTES_CPU=$path"; continue; }
			s=$(render_time "$n" vrender "$t.scene" --transport "$t")
			rate=$(ratio "$n" "$s")
			: "${scalar:=$rate}"
			r=$(ratio "$rate" "$scalar")
			printf '%s\tMOTES_CPU=%s\t%s\t%s\t%s\tscalar\n' "$t" $path "$n" "$s" "$r" >>lanes.tsv
			case $path in
			v3) need "$t, v3 over scalar" "$r" $v3 x ;;
			v4) need "$t, v4 over scalar" "$r" $v4 x ;;
			esac
		done
		unset MOTES_CPU
		n=$((2 * $(samples_for "$seconds" vrender "$t.scene" --transport "$t")))
		vrender "$t.scene" --transport "$t" --backend opencl --samples "$n" -o cl.exr      # fills the cache
		for _ in 1 2 3; do      # what else the machine does should not hit one of the two alone: the best of three in turn
			render_time -w "$n" vrender "$t.scene" --transport "$t" --threads 2 >>"c.$t"
			render_time -w "$n" vrender "$t.scene" --transport "$t" --backend opencl >>"cl.$t"
		done
		c=$(sort -g "c.$t" | head -n 1) s=$(sort -g "cl.$t" | head -n 1)
		r=$(ratio "$c" "$s")
		printf '%s\tOpenCL, 2 threads\t%s\t%s\t%s\tC, 2 threads\n' "$t" "$n" "$s" "$r" >>lanes.tsv
		need "$t, OpenCL over C" "$r" 0.8 x
	done
	cp lanes.tsv "$out"
	cat lanes.tsv
	exit $failed
}
