# shellcheck shell=sh
# Clouds of 10^3 to 10^6 particles of the same extinction against the continuous medium, 16 of each, rendered by explicit and fat-ray: the
# rms over blocks of 8 x 8 pixels without Monte Carlo noise, and the mean. tests/support/media.sh says what they look like.
# Prints convergence.tsv, a line PASS or FAIL for each transport, and draws convergence.png and .svg. Required: slope -0.5 +- 0.1, the mean
# within 4 standard errors at each N (of 16 clouds: beyond by chance once in 900).
# usage, by tests/bench/run: convergence.sh OUT
out=$1
bench=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/support/media.sh
. "$bench/../support/media.sh"
clouds_setup
continuum 2048
for t in explicit fat-ray; do
	departs 1000 $t 8 16
	departs 10000 $t 8 16
	departs 100000 $t 16 16
	departs 1000000 $t 32 16
done >lines
limit >mean
read -r m error <mean
law "$m" "$error" <lines >laws
{
	printf '# transport\tN\tA/C\tclouds\trms\tmean\terror\tz (of the mean, from %s +- %s)\n' "$m" "$error"
	grep -v '^slope' laws
} | tee "$out/convergence.tsv"
failed=0
for t in explicit fat-ray; do
	awk -F'\t' -v t=$t '
		$1 == t && ($8 > 4 || $8 < -4) { bad++ }
		$1 == t && $8 * $8 >= worst * worst { worst = $8 }
		$1 == "slope" && $2 == t { slope = $3 }
		END {
			bad += !(slope >= -0.6 && slope <= -0.4)
			print (bad ? "FAIL" : "PASS") " " t ": slope " slope ", mean at most " worst " standard errors off"
			exit bad > 0
		}' laws || failed=1
done
if ! command -v gnuplot >/dev/null; then
	echo 'bench: convergence: no charts without gnuplot (make deps)' >&2
	exit $failed
fi
cp "$out/convergence.tsv" .
cat >convergence.gp <<'EOG'
set datafile separator "\t"
set logscale xy
set grid back lc rgb "#dddddd"
set format "10^{%L}"
set key top right
set title "grains against the continuous medium, blocks of 8 x 8 pixels"
set xlabel "particles, of the same extinction in all"
set ylabel "rms difference of radiance, of a mean near 0.52"
set xrange [600:2e6]
of(t) = "< grep ^".t." convergence.tsv"
plot 8 / sqrt(x) lw 1 lc rgb "#888888" dt 2 title "slope -1/2", \
	of("explicit") using 2:5 with linespoints lw 2 lc 1 pt 7 title "explicit", \
	of("fat-ray") using 2:5 with linespoints lw 2 lc 2 pt 5 title "fat-ray", \
	of("fat-ray") using 2:5:(sprintf("A/C %s", stringcolumn(3))) with labels offset 0, -1 font ",9" notitle
EOG
for kind in 'png pngcairo' 'svg svg'; do
	gnuplot -e "set terminal ${kind#* } size 760,520 font 'sans,11' background '#ffffff'; set output 'convergence.${kind% *}'" convergence.gp
done
cp convergence.png convergence.svg "$out"
exit $failed
