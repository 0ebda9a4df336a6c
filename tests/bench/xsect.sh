# shellcheck shell=sh
# xsect --method auto against --method mie, by tolerance: what it saves, and whether what it promises is true.
#
# xsect.tsv         CPU time a size of 20,000 sizes, x = 0.01 .. 1e5 evenly in the logarithm, of one index, reading and writing in it; the
#                   least of several runs in turn. speed-up: over mie's. share: of the sizes, by method.
# xsect_honest.tsv  random spheres (x = 0.01 .. 1e5; real m above and below 1, absorbing): the share for which the truth, the larger of the
#                   relative errors of c_ext and c_sca and the absolute error of g, is worse than the method's estimate, or than auto's
#                   tolerance; and how much worse at most.
#
# Prints the tables and lines PASS or FAIL, and draws xsect.png and .svg.
# usage, by tests/bench/run: [BENCH_QUICK=1] xsect.sh OUT
out=$1
bench=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/bench/timing
. "$bench/timing"
sizes=20000 spheres=20000 runs='1 2 3'
[ -z "${BENCH_QUICK:-}" ] || sizes=2000 spheres=2000 runs='1 2'
tolerances='1e-1 1e-2 1e-3 1e-4 1e-5 1e-6'
failed=0

# ---- what it saves

printf '# m\ttolerance\tus a size, auto\tus a size, mie\tspeed-up\trayleigh\tcam\tevans-fournier\tmie\n' >xsect.tsv
for m in 1.33 1.49 1.5+0.1i 0.75; do
	for _ in $runs; do
		seconds xsect --particle $m --size-parameter 0.01:1e5:$sizes --method mie >>"mie.$m"
		for t in $tolerances; do
			seconds xsect --particle $m --size-parameter 0.01:1e5:$sizes --tolerance "$t" >>"auto.$m.$t"
		done
	done
	for t in $tolerances; do
		xsect --particle $m --size-parameter 0.01:1e5:$sizes --tolerance "$t" | tabtxt --columns method |
			awk -v OFS='\t' -v m=$m -v t="$t" -v n=$sizes -v auto="$(least <"auto.$m.$t")" -v mie="$(least <"mie.$m")" '
			NR > 1 { count[$1]++ }
			END {
				print m, t, sprintf("%.3g", auto / n * 1e6), sprintf("%.3g", mie / n * 1e6), sprintf("%.3g", mie / auto), \
					count[2] / n, count[4] / n, count[5] / n, count[1] / n
			}'
	done
done | tee -a xsect.tsv
awk -F'\t' '
	NR > 1 {
		limit = $7 + $8 > 0 ? 1 : 0.9     # where only the smallest spheres are spared, both take the same time
		ok = $5 >= limit
		printf("%s m = %s, tolerance %s: %s times as fast as mie, required %s\n", ok ? "PASS" : "FAIL", $1, $2, $5, limit)
		bad += !ok
	}
	END { exit bad > 0 }' xsect.tsv || failed=1

# ---- whether it is true

"$MOTES_TESTS/physics/method_selection" --honest $spheres | tee xsect_honest.tsv
awk -F'\t' '
	NR > 1 {
		ok = $4 < 0.01 && $5 < 10
		printf("%s %s%s: %s of %d spheres worse than promised, at most %s times, required less than 0.01, 10\n", \
			ok ? "PASS" : "FAIL", $1, \
			$2 == "-" ? "" : ", tolerance " $2, $4, $3, $5)
		bad += !ok
	}
	END { exit bad > 0 }' xsect_honest.tsv || failed=1

cp xsect.tsv xsect_honest.tsv "$out"
if ! command -v gnuplot >/dev/null; then
	echo 'bench: xsect: no charts without gnuplot (make deps)' >&2
	exit $failed
fi
cat >xsect.gp <<'EOT'
set datafile separator "\t"
set logscale xy
set grid back lc rgb "#dddddd"
set format x "10^{%L}"
set format y "%g"
set key top right
set title "cross sections, x = 0.01 .. 10^5: speed-up over Lorenz-Mie theory"
set xlabel "tolerance"
set ylabel "times as fast as --method mie"
pick(m) = sprintf("< awk -F'\t' -v m=%s '$1 == m' xsect.tsv", m)
plot for [i = 1:4] pick(word("1.33 1.49 1.5+0.1i 0.75", i)) using 2:5 with linespoints lw 2 lc i pt 5 + 2 * i ps 0.8 \
	title "m = ".word("1.33 1.49 1.5+0.1i 0.75", i)
EOT
for kind in 'png pngcairo' 'svg svg'; do
	gnuplot -e "set terminal ${kind#* } size 800,560 font 'sans,11' background '#ffffff'; set output 'xsect.${kind% *}'" xsect.gp
done
cp xsect.png xsect.svg "$out"
exit $failed
