# shellcheck shell=sh
# The cost of an explicit ray against the number of particles, 10^4 to 10^7 of the same extinction: a cube of side 2 m, optical depth 2, seen
# from the front by a camera all of whose rays cross it, particles that only absorb: a sample is one ray, which ends at its first particle.
# A ray crosses cells of medium-bake's grid; on the average (1 - e^-2)/2 of those from face to face before it meets a particle.
# Prints particles.tsv, a line PASS or FAIL, and draws particles.png and .svg. Required: the time of a ray grows no faster than the cells it
# crosses, from the least N to the most. From one N to the next it may, where the particles no longer fit a cache.
# usage, by tests/bench/run: [BENCH_SECONDS=3] [BENCH_PARTICLES='1e4 1e5 1e6 1e7'] particles.sh OUT
out=$1
bench=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/support/media.sh
. "$bench/../support/media.sh"
# shellcheck source=tests/bench/timing
. "$bench/timing"
seconds=${BENCH_SECONDS:-3}
sizes 1 >one.psd
hg 0 >0.phase
cat >rays.scene <<'EOT'
camera = { position = [0.0, 0.0, 10.0]; target = [0.0, 0.0, 0.0]; fov = 9.5; resolution = [256, 256]; };
medium = { file = "rays.medium"; };
lights = ( { type = "environment"; radiance = 1.0; } );
EOT
printf '# particles\trays/s\tus a ray\tcells crossed\tns a cell\ttime, to the N before\tcells, to the N before\n' | tee particles.tsv
for n in ${BENCH_PARTICLES:-1e4 1e5 1e6 1e7}; do
	xsections "$(awk -v n="$n" 'BEGIN { printf "%.17g 0", 8e12 / n }')" >c.xsect
	particles --psd one.psd --count "$n" --box 2m,2m,2m | medium-bake --xsect c.xsect --phase 0.phase --box 2m,2m,2m -o rays.medium
	cells=$(grep -a -m 1 '^grid' rays.medium | cut -f 4)
	samples=$(samples_for "$seconds" vrender rays.scene --transport explicit)
	t=$(render_time "$samples" vrender rays.scene --transport explicit)
	echo "$n $samples $t $cells"
done | awk -v OFS='\t' '{
	us = $3 / $2 / 65536 * 1e6; cells = $4 * (1 - exp(-2)) / 2
	print $1, sprintf("%.4g", 1e6 / us), sprintf("%.4g", us), sprintf("%.4g", cells), sprintf("%.3g", 1000 * us / cells), \
		(NR > 1 ? sprintf("%.3g", us / before) : "-"), (NR > 1 ? sprintf("%.3g", cells / crossed) : "-")
	before = us; crossed = cells }' | tee -a particles.tsv
cp particles.tsv "$out"
failed=0
awk -F'\t' '
	/^#/ { next }
	!n++ { us = $3; cells = $4 }
	{ last = $1; time = $3 / us; crossed = $4 / cells }
	n > 1 && $6 / $7 > worst { worst = $6 / $7; at = $1 }
	END {
		printf "%s explicit: up to %s particles a ray takes %.3g times as long and crosses %.3g times the cells", \
			time <= crossed ? "PASS" : "FAIL", last, time, crossed
		printf "; in one step at most %.2f times as the cells, to %s\n", worst, at
		exit !(time <= crossed)
	}' particles.tsv || failed=1
if ! command -v gnuplot >/dev/null; then
	echo 'bench: particles: no charts without gnuplot (make deps)' >&2
	exit $failed
fi
cat >particles.gp <<'EOG'
set logscale xy
set grid back lc rgb "#dddddd"
set format "10^{%L}"
set key top right
set title "explicit: rays of one thread, optical depth 2"
set xlabel "particles, of the same extinction in all"
set ylabel "rays a second"
set y2label "cells a ray crosses"
set y2tics
set logscale y2
set format y2 "%g"
plot "particles.tsv" using 1:2 with linespoints lw 2 lc 1 pt 7 title "rays a second", \
	"particles.tsv" using 1:4 axes x1y2 with linespoints lw 2 lc 2 pt 5 title "cells a ray crosses (right)"
EOG
for kind in 'png pngcairo' 'svg svg'; do
	gnuplot -e "set terminal ${kind#* } size 760,520 font 'sans,11' background '#ffffff'; set output 'particles.${kind% *}'" particles.gp
done
cp particles.png particles.svg "$out"
exit $failed
