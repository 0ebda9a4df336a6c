# shellcheck shell=sh
# Lorenz-Mie theory: error and time of xsect and mie-phase beside the codes of PyPI (miepython with its JIT, lxmie, scattnlay) and the
# textbook's loop in C (mie_textbook.c, -O3 -march=native). One thread, CPU time, one run.
#
# mie_errors.tsv   every row of the reference efficiencies: relative error of Q_ext, Q_sca, g, Q_back by each code; - where it has none
# mie_regions.tsv  by region: rows, failures (no number), median and worst error of Q_ext, Q_sca and g, worst of Q_back. What no double
#                  can know of narrow resonances and of m near 1 is in them.
# mie.tsv          ns a term: of efficiencies over 5 % of sizes from x up; and a term and angle, of amplitudes at 1801 equal angles. Terms
#                  are counted as x + 4.05 x^(1/3) + 8 for all. The tools' times have reading, writing and all in them, the others' not;
#                  mie-phase is timed without the one size's start. ratio: to the textbook's.
# mie_series.tsv   mie-phase with all angles at once against --direct
#
# Prints the tables and lines PASS or FAIL: the requirements by AVX-512, half of them by AVX2 (or by MOTES_CPU alone), and draws mie.png and
# .svg.
# usage, by tests/bench/run: [MOTES_PEERS=VENV] [MOTES_ARCHIVE=libmotes.a] [MOTES_CPU=..] [BENCH_QUICK=1] mie.sh OUT
out=$1
bench=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/bench/timing
. "$bench/timing"
python=${MOTES_PEERS:-none}/bin/python
peer() { "$python" "$bench/mie_peers.py" "$@"; }
peers=
if [ -x "$python" ] && peer list >list.txt 2>err; then
	peers=$(cut -d' ' -f1 list.txt)
	echo "peers: $(paste -sd, list.txt | sed 's/,/, /g')"
fi
for p in miepython lxmie scattnlay; do
	case " $(echo "$peers" | paste -sd' ' -) " in *" $p "*) ;; *) echo "bench: mie: no $p here (make bench-mie gets it): left out" >&2 ;; esac
done
${CC:-cc} -std=gnu11 -O3 -march=native -o textbook "$bench/mie_textbook.c" -lm

# ---- errors over the reference rows, those of one index together

tr -d '\r' <"$bench/../data/mie_efficiencies.csv" | awk -F, '
	NR > 1 { k = $2 "," $3; if (!(k in rows)) order[++n] = k; rows[k] = rows[k] $0 "\n" }
	END { for (i = 1; i <= n; i++) printf "%s", rows[order[i]] }' >rows.csv
awk -F, '{ print $1, $2, $3 }' rows.csv >rows.txt
awk '{ k = $2 "+" $3 "i"; if (k != old) printf("%s%s ", (NR > 1 ? "\n" : ""), k); else printf ","; printf "%s", $1; old = k } END { print "" }' rows.txt |
	while read -r m x; do
		xsect --method mie --particle "$m" --size-parameter "$x" | tabtxt --columns q_ext,q_sca,g,q_back | sed 1d
	done >values.motes
while read -r x re im; do ./textbook "$re" "$im" "$x"; done <rows.txt >values.textbook
for p in $peers; do
	: >values."$p"
	# a code that stops, or hangs, has failed on the row where it did
	while done=$(wc -l <values."$p") && [ "$done" -lt "$(wc -l <rows.txt)" ]; do
		tail -n +$((done + 1)) rows.txt | timeout 120 "$python" "$bench/mie_peers.py" "$p" q >>values."$p" 2>>err || echo 'nan nan nan nan' >>values."$p"
	done
done
printf '# code\tx\tm_re\tm_im\tsource\tq_ext\tq_sca\tg\tq_back\n' >mie_errors.tsv
for code in motes textbook $peers; do
	tr '\t' ' ' <values."$code" | paste -d, rows.csv - | awk -F, -v OFS='\t' -v code="$code" '
		{
			split($NF, v, " ")
			line = code OFS $1 OFS $2 OFS $3 OFS $8
			for (i = 1; i <= 4; i++) {
				d = v[i] - $(i + 3)
				e = d < 0 ? -d / $(i + 3) : d / $(i + 3)
				if (e < 0) e = -e
				line = line OFS (v[i] ~ /nan|inf/ || v[i] == "" ? "-" : sprintf("%.2g", e))
			}
			print line
		}'
done >>mie_errors.tsv
printf '# region\tcode\trows\tfailed\tmedian\tworst\tworst of q_back\n' >mie_regions.tsv
for region in 'narrow resonances' 'm within 1e-3 of 1' 'x < 0.1' '0.1 <= x < 10' '10 <= x < 1000' '1000 <= x' '|m| >= 5' 'all'; do
	for code in motes textbook $peers; do
		awk -F'\t' -v code="$code" -v region="$region" '
			NR == 1 || $1 != code { next }
			{
				res = $5 ~ /^res/; near = ($3 - 1)^2 + $4^2 < 1e-6
				if (region == "narrow resonances" ? !res : region == "m within 1e-3 of 1" ? !near : region == "|m| >= 5" ? $3^2 + $4^2 < 25 || res : \
					region == "all" ? 0 : res || near || $2 < lo || $2 >= hi) next
				e = 0
				for (i = 6; i <= 8; i++) if ($i == "-") e = 1e99; else if ($i + 0 > e) e = $i + 0
				print e, $9
			}
			BEGIN {
				lo = region ~ /^0.1/ ? 0.1 : region ~ /^10 / ? 10 : region ~ /^1000/ ? 1000 : 0
				hi = region ~ /^x </ ? 0.1 : region ~ /^0.1/ ? 10 : region ~ /^10 / ? 1000 : 1e99
			}' mie_errors.tsv | sort -g | awk -v OFS='\t' -v code="$code" -v region="$region" '
			{ if ($1 < 1e98) v[++n] = $1; else bad++; if ($2 == "-") none++; else if ($2 + 0 > back) back = $2 + 0 }
			END { print region, code, NR, bad + 0, n ? v[int((n + 1) / 2)] : "-", n ? v[n] : "-", none == NR ? "-" : back + 0 }'
	done
done >>mie_regions.tsv

# ---- times

terms() { awk -v a="$1" -v b="$2" 'BEGIN { for (i = 0; i <= 20; i++) { x = a * (b / a)^(i / 20); s += int(x + 4.05 * x^(1 / 3) + 8) } print s / 21 }'; }
# count WORK TERMS MOST
count() { awk -v w="$1" -v t="$2" -v m="$3" 'BEGIN { n = int(w / t); print (n < 1 ? 1 : n > m ? m : n) }'; }
# tool X0 X1 COUNT COMMAND..: seconds a size, start left out
tool() {
	x0=$1 x1=$2 n=$3
	shift 3
	[ "$n" -gt 1 ] && range=$x0:$x1:$n || range=$x0
	for _ in 1 2 3; do cpu "$@" --size-parameter "$range"; done | least >long.txt
	for _ in 1 2 3; do cpu "$@" --size-parameter 0.1; done | least >short.txt
	paste long.txt short.txt | awk -v n="$n" '{ t = $1 - $2; print (t > 0.005 ? t : 0.005) / n }'
}
# timed PEER M_RE M_IM X0 X1 COUNT [ANGLES]: seconds a size; fails where it takes longer than half a minute
timed() {
	who=$1
	shift
	timeout 30 "$python" "$bench/mie_peers.py" "$who" time "$@" 2>>err ||
		{ echo "bench: mie: $who at x = $3: no time, it failed or took more than half a minute" >&2; return 1; }
}
line() { printf '%s\t%s\t%s\t%s\t%s\t%s\n' "$1" "$2" "$3" "$4" "$5" "$(awk -v a="$6" -v b="$5" 'BEGIN { printf "%.3g", a / b }')"; }
per() { awk -v s="$1" -v n="$2" -v t="$3" 'BEGIN { printf "%.4g\n", s * 1e9 / n / t }'; }
big=40000000
[ -z "${BENCH_QUICK:-}" ] || big=4000000
printf '# what\tm\tx\tcode\tns a term (and angle)\ttimes as fast as textbook\n' >mie.tsv
for m in '1.33 0' '1.5 0.1'; do
	re=${m% *} im=${m#* }
	for x in 1 10 100 1000 10000 100000; do
		to=$(awk -v x=$x 'BEGIN { print 1.05 * x }')
		t=$(terms $x "$to")
		book=$(for _ in 1 2 3; do ./textbook "$re" "$im" $x "$to" "$(count $((big / 4)) "$t" 100000)" 2>err; done | least)
		line efficiencies "$re+${im}i" $x textbook "$book" "$book"
		n=$(count $big "$t" 200000)
		line efficiencies "$re+${im}i" $x motes "$(per "$(tool "$x" "$to" "$n" xsect --method mie --particle "$re+${im}i")" 1 "$t")" "$book"
		n=$(count $((big / 10)) "$t" 20000)
		for p in $peers; do
			s=$(timed "$p" "$re" "$im" $x "$to" "$n") || continue
			line efficiencies "$re+${im}i" $x "$p" "$(per "$s" 1 "$t")" "$book"
		done
	done
	for x in 10 100 1000 10000; do
		to=$(awk -v x=$x 'BEGIN { print 1.05 * x }')
		t=$(terms $x "$to")
		book=$(for _ in 1 2 3; do ./textbook "$re" "$im" $x "$to" "$(count $((big / 800)) "$t" 1000)" 1801 2>err; done | least)
		line amplitudes "$re+${im}i" $x textbook "$book" "$book"
		n=$(count $((big / 80)) "$t" 400)
		line amplitudes "$re+${im}i" $x motes "$(per "$(tool "$x" "$to" "$n" mie-phase --direct --angles 1801 --particle "$re+${im}i")" 1801 "$t")" "$book"
		n=$(count $((big / 800)) "$t" 100)
		for p in $peers; do
			s=$(timed "$p" "$re" "$im" $x "$to" "$n" 1801) || continue
			line amplitudes "$re+${im}i" $x "$p" "$(per "$s" 1801 "$t")" "$book"
		done
	done
done | tee -a mie.tsv

# ---- what is required

failed=0
# need WHAT GOT LIMIT
need() {
	awk -v what="$1" -v got="$2" -v limit="$3" 'BEGIN {
		ok = got >= limit
		print (ok ? "PASS" : "FAIL") " " what ": " got "x, required at least " limit "x"
		exit !ok }' || failed=1
}
ratio() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%.3g\n", a / b }'; }
# levels: what to time, of what this processor has; half: what of the requirements holds there
levels=${MOTES_CPU:-$(grep -q avx512dq /proc/cpuinfo && echo v4; grep -q avx2 /proc/cpuinfo && echo v3)}
half() { case $1 in v4) echo 1 ;; *) echo 2 ;; esac; }
half=$(half "${levels%%[!v0-9]*}")
sizes=1000000    # seconds, not ticks
[ -z "${BENCH_QUICK:-}" ] || sizes=400000
t=$(awk -v n=1000 'BEGIN { for (i = 0; i < n; i++) { x = 0.1 * 10000^(i / (n - 1)); s += int(x + 4.05 * x^(1 / 3) + 8) } print s / n }')
for m in '1.33 0 15' '1.5 0.1 10'; do
	re=$(echo "$m" | cut -d' ' -f1) im=$(echo "$m" | cut -d' ' -f2) limit=$(echo "$m" | cut -d' ' -f3)
	book=$(for _ in 1 2 3; do ./textbook "$re" "$im" 0.1 1000 50000 2>err; done | least)
	for level in $levels; do
		own=$(per "$(MOTES_CPU=$level tool 0.1 1000 "$sizes" xsect --method mie --particle "$re+${im}i")" 1 "$t")
		need "xsect, $level, m = $re+${im}i, 0.1:1000:$sizes, a term" "$(ratio "$book" "$own")" "$(ratio "$limit" "$(half "$level")")"
	done
done
if [ -f "${MOTES_ARCHIVE:-}" ]; then
	${CC:-cc} -std=gnu11 -O2 -fopenmp -I"$bench/../../lib" -o alone "$bench/mie_alone.c" "$MOTES_ARCHIVE" -lm
	for m in '1.33 0' '1.5 0.1'; do
		re=${m% *} im=${m#* }
		for x in 100 1000 10000; do
			n=$(count $((big / 4)) "$x" 100000)
			book=$(for _ in 1 2 3; do ./textbook "$re" "$im" $x $x "$n" 2>err; done | least)
			for level in $levels; do
				own=$(for _ in 1 2 3; do MOTES_CPU=$level ./alone "$re" "$im" $x "$n" 2>err; done | least)
				need "a single size, $level, m = $re+${im}i, x = $x" "$(ratio "$book" "$own")" "$(ratio 4 "$(half "$level")")"
			done
		done
	done
else
	echo 'bench: mie: single sizes below 1e5 are not timed without MOTES_ARCHIVE (make bench-mie)' >&2
fi
for m in '1.33 0' '1.5 0.1'; do
	re=${m% *} im=${m#* }
	for x in 100000 1000000; do      # so large that each is computed by itself; many, since ticks are 10 ms
		book=$(for _ in 1 2 3; do ./textbook "$re" "$im" $x $x 1 2>err; done | least)
		own=$(per "$(tool $x "$x.1" $((10000000 / x)) xsect --method mie --particle "$re+${im}i")" 1 "$(terms $x $x)")
		need "xsect, single sizes, m = $re+${im}i, x = $x" "$(ratio "$book" "$own")" "$(ratio 4 "$half")"
	done
done
book=$(for _ in 1 2 3; do ./textbook 1.33 0 2900 3100 10 1801 2>err; done | least)
own=$(per "$(tool 2900 3100 40 mie-phase --direct --angles 1801 --particle 1.33)" 1801 "$(terms 2900 3100)")
need 'mie-phase --direct --angles 1801, 2900:3100:40, a term and angle' "$(ratio "$book" "$own")" "$(ratio 14 "$half")"

printf '# x\tangles\tsizes\ts, --direct\ts, all at once\tratio\n' >mie_series.tsv
for c in '10000 10100 20 18001 2' '100000 100000 1 180001 10'; do
	x=$(echo "$c" | cut -d' ' -f1) to=$(echo "$c" | cut -d' ' -f2) n=$(echo "$c" | cut -d' ' -f3) angles=$(echo "$c" | cut -d' ' -f4)
	range=$x
	[ "$n" -eq 1 ] || range=$x:$to:$n
	for _ in 1 2 3; do
		cpu mie-phase --particle 1.33 --size-parameter "$range" --angles "$angles" >>fast.txt
		if [ ! -s direct.txt ] || [ "$n" -gt 1 ]; then cpu mie-phase --particle 1.33 --size-parameter "$range" --angles "$angles" --direct >>direct.txt; fi
	done
	fast=$(least <fast.txt) direct=$(least <direct.txt)
	printf '%s\t%s\t%s\t%s\t%s\t%s\n' "$x" "$angles" "$n" "$direct" "$fast" "$(ratio "$direct" "$fast")" >>mie_series.tsv
	need "mie-phase, x = $x, $angles angles: all at once over --direct" "$(ratio "$direct" "$fast")" "$(echo "$c" | cut -d' ' -f5)"
	rm fast.txt direct.txt
done
t=$(wall mie-phase --particle 1.33 --size-parameter 1e6 --angles 1800001 -o large.tab)
need "mie-phase, x = 1e6, 1800001 angles, a minute over $t s" "$(ratio 60 "$t")" 1

cp mie.tsv mie_errors.tsv mie_regions.tsv mie_series.tsv "$out"
cat mie_regions.tsv mie_series.tsv
if ! command -v gnuplot >/dev/null; then
	echo 'bench: mie: no charts without gnuplot (make deps)' >&2
	exit $failed
fi
cat >mie.gp <<'EOT'
set datafile separator "\t"
set datafile missing "-"
set multiplot layout 1,3
set logscale xy
set grid back lc rgb "#dddddd"
set format "%g"
set key outside bottom center horizontal maxcols 3 reverse Left
set xlabel "size parameter x"
code(i) = word(CODES, i)
colour(i) = int(word("1 8 2 4 7", i))
pick(what, i, m) = sprintf("< awk -F'\t' -v w=%s -v c=%s -v m=%s '$1 == w && $4 == c && $2 == m' mie.tsv", what, code(i), m)
set title "efficiencies: time, m = 1.33 (full), 1.5+0.1i (dashed)"
set ylabel "ns a term"
plot for [i = 1:words(CODES)] for [j = 1:2] pick("efficiencies", i, word("1.33+0i 1.5+0.1i", j)) using 3:5 with linespoints lw 2 lc colour(i) \
	dt j pt 5 + 2 * j ps 0.6 title (j == 1 ? code(i) : "")
set title "amplitudes at 1801 angles, each summed: time"
set ylabel "ns a term and angle"
plot for [i = 1:words(CODES)] for [j = 1:2] pick("amplitudes", i, word("1.33+0i 1.5+0.1i", j)) using 3:5 with linespoints lw 2 lc colour(i) \
	dt j pt 5 + 2 * j ps 0.6 title (j == 1 ? code(i) : "")
set title "error over the reference rows"
set ylabel "largest relative error of Q_{ext}, Q_{sca}, g"
set yrange [5e-17:10]
set ytics 1e-16, 100
error(i) = sprintf("< awk -F'\t' -v c=%s '$1 == c { e = 1e-16; for (i = 6; i <= 8; i++) if ($i == \"-\" || $i > 5) e = 5; else if ($i + 0 > e) e = $i + 0; print $2 FS e }' mie_errors.tsv", code(i))
plot for [i = words(CODES):1:-1] error(i) using 1:2 with points lc colour(i) pt (i == 1 ? 7 : 5 + 2 * i) ps (i == 1 ? 0.5 : 0.7) title code(i)
unset multiplot
EOT
for kind in 'png pngcairo' 'svg svg'; do
	gnuplot -e "set terminal ${kind#* } size 1600,560 font 'sans,11' background '#ffffff'; set output 'mie.${kind% *}'; \
		CODES = 'motes textbook $(echo "$peers" | paste -sd' ' -)'" mie.gp
done
cp mie.png mie.svg "$out"
exit $failed
