# shellcheck shell=sh
# vrender against Mitsuba 3 on four scenes, one thread each: efficiency = 1 / (relMSE x seconds of CPU time).
#
# relMSE: the mean over pixels of (image - reference)^2 / (reference^2 + 0.01), imgcmp's, less what is the reference's own. That is an image
#         of vrender from other seeds, some twenty times as long as what it judges; its noise is told by its two halves.
# CPU:    of rendering alone. vrender: user and system time of the process, less that of one sample a pixel; OpenCL with a warm
#         cache and one thread of PoCL. Mitsuba: of the calls that render, after one that compiles.
# z:      the mean of the image less that of the reference, in standard errors.
# ratio:  of the efficiency to the best of Mitsuba's configurations: variants x roulette from the fifth scattering (the default) or none x
#         volpath or volpathmis. "tuned" are two more, which draw the sun alone for next-event estimation and leave the sky to scattered
#         rays, as vrender does; ratio_tuned is to the best of all. Of each configuration its longest image
#         counts. (Mitsuba 3.9.1's volpathmis with roulette is 0.2 % too dark in the first scene; its relMSE has that in it.)
#
# An efficiency counts only if both estimate the same: the means of 1,024 blocks of 8 x 8 pixels, of a long image of Mitsuba's best
# configuration and of the reference, differ by their noise. The means of the first two scenes are known:
# 0.36437 +- 0.00006 and 0.2837 +- 0.0003, found the same by two independent programs.
#
# Prints render.tsv, lines PASS or FAIL, and draws render.png and .svg.
# usage, by tests/bench/run, with tests/support/block_means on the PATH: [MOTES_MITSUBA=VENV] [BENCH_SECONDS=4]
#        [BENCH_SCENES='isotropic c1 cloud sparse'] render.sh OUT
out=$1
bench=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/support/media.sh
. "$bench/../support/media.sh"
# shellcheck source=tests/bench/timing
. "$bench/timing"
export POCL_MAX_PTHREAD_COUNT=1
scenes=${BENCH_SCENES:-isotropic c1 cloud sparse}
python=${MOTES_MITSUBA:-none}/bin/python
mitsuba() { DRJIT_CACHE_DIR=$PWD/drjit "$python" "$bench/mitsuba3.py" "$@"; }
mkdir drjit
variants=
if version=$(mitsuba --version 2>err); then
	variants=$(mitsuba --variants 2>err)
	echo "Mitsuba $version: $(echo "$variants" | paste -sd " " -)"
else
	echo 'bench: render: no Mitsuba here (make bench-render gets it), so only vrender is timed' >&2
fi

# ---- the scenes: all in the cube [-1, 1]^3, before the same camera, sun and sky

# scene NAME EXTINCTION ALBEDO PHASE_FOR_MITSUBA TABLE [GRID]: NAME.scene and NAME.medium, and NAME.mitsuba, which says the same
scene() {
	xsections "$(awk -v e="$2" -v a="$3" 'BEGIN { printf "%.17g %.17g", e * 1e6, e * 1e6 * a }')" >scene.xsect
	medium-bake --xsect scene.xsect --phase "$5" --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m ${6:+--density $6} -o "$1.medium"
	printf 'extinction %s\nalbedo %s\nphase %s\n' "$2" "$3" "$4" >"$1.mitsuba"
	[ -z "${6:-}" ] || echo "density $6" >>"$1.mitsuba"
	view "$1" 256
}
sizes 1 >one.psd
hg 0 >0.phase
for here in $scenes; do
	case $here in
	isotropic) scene isotropic 4 0.99 isotropic 0.phase ;;
	c1)     # Deirmendjian's cloud C1: n(r) ~ r^6 e^(-1.5 r/um)
		psd gamma --effective-radius 6um --effective-variance 0.11111111111111 --min 0.02um --max 16um --classes 100 |
			mie-phase --particle 1.333 --wavelength 550nm --average >c1.phase
		tabtxt --columns theta,p c1.phase >c1.txt
		scene c1 6 0.999 c1.txt c1.phase ;;
	cloud)
		perl "$bench/density.pl" cloud >cloud.npy
		hg 0.85 >0.85.phase
		scene cloud 30 0.999 0.85 0.85.phase cloud.npy ;;
	sparse)
		perl "$bench/density.pl" sparse >sparse.npy
		scene sparse 100 0.99 isotropic 0.phase sparse.npy ;;
	esac
done

# ---- timing

# row SCENE RENDERER CONFIGURATION SAMPLES CPU IMAGE: a line of rows
row() {
	imgcmp --channels G --rms 99 --block 256 ref.exr "$6" | awk -v OFS='\t' -v s="$1" -v r="$2" -v c="$3" -v n="$4" -v t="$5" -v own="$own" '
		$1 == "G" { e = $3 - own; print s, r, c, n, t, sprintf("%.4g", e), sprintf("%.4g", 1 / e / t), sprintf("%.2f", $5 / $2 * 256) }' >>rows
	tail -n 1 rows
}
# ours SCENE RENDERER CONFIGURATION [OPTION..]: three images, of about $seconds, a quarter and a sixteenth of that
ours() {
	scene=$1 renderer=$2 configuration=$3
	shift 3
	samples=$(samples_for "$seconds" vrender "$scene.scene" --seed 7 "$@") || { echo "bench: render: not here: $configuration" >&2; return; }
	for n in $((samples / 16)) $((samples / 4)) "$samples"; do
		[ "$n" -ge 2 ] || continue
		t=$(render_time "$n" vrender "$scene.scene" --seed 7 "$@")
		row "$scene" "$renderer" "$configuration" "$n" "$t" timed.exr
	done
}
# jobs: what mitsuba3.py renders with one variant: name, integrator, roulette, sun's share
jobs() {
	for tuned in 0.5 1; do
		for integrator in volpath volpathmis; do
			for rr in 5 1000000; do
				name=$integrator
				[ $rr = 5 ] || name="$name, no roulette"
				[ $tuned = 0.5 ] || name="$name, tuned"
				[ "$tuned $integrator" = '1 volpathmis' ] || printf '%s\t%s %s %s\n' "$name" $integrator $rr $tuned
			done
		done
	done
}
# theirs SCENE VARIANT
theirs() {
	jobs >jobs.txt
	awk -F'\t' -v t="$seconds" '{ print $2, t / 4 "s 1 short." NR ".pfm"; print $2, t "s 2 long." NR ".pfm" }' jobs.txt |
		mitsuba "$2" "$1.mitsuba" >times.txt
	n=0
	while IFS='	' read -r name _; do
		n=$((n + 1))
		for length in short long; do
			read -r samples t
			oiiotool $length.$n.pfm -d float -o theirs.exr
			row "$1" Mitsuba "$2 $name" "$samples" "$t" theirs.exr
		done <<-EOT
			$(sed -n "$((2 * n - 1)),$((2 * n))p" times.txt)
		EOT
	done <jobs.txt
}

# longest FILE: of each configuration the last of its rows, whose error is known best and which alone counts
longest() { awk -F'\t' '{ k = $1 $2 $3; if (!(k in row)) order[++n] = k; row[k] = $0 } END { for (i = 1; i <= n; i++) print row[order[i]] }' "$1"; }

failed=0
judge() { if [ "$1" -eq 0 ]; then echo "PASS $2"; else echo "FAIL $2"; failed=1; fi; }

# known WANT ERROR: the reference's mean, which knows its standard error by its halves
known() {
	printf 'the mean\t%s\t%s\t%s\n' "$1" "$mean" "$(awk -v a="$2" -v b="$error" 'BEGIN { print sqrt(a * a + b * b) }')" | zs 4 0 4 >/dev/null
	judge $? "$here: mean $mean +- $error, known $1 +- $2"
}
# agree SCENE: Mitsuba's best configuration against the reference. The mean of the squared differences of blocks is that of their variances,
# whatever the tails; within 1.2 for the roots, which of 200 normal values chance leaves once in 10^4.
agree() {
	longest rows | awk -F'\t' -v s="$1" '$1 == s && $2 == "Mitsuba" && $7 > most { most = $7; best = $3 } END { print best }' >best
	read -r variant name <best
	jobs | awk -F'\t' -v name="$name" -v t="$seconds" '$1 == name { for (i = 1; i <= 2; i++) print $2, 5 * t "s", 2 + i, "m." i ".pfm" }' |
		mitsuba "$variant" "$1.mitsuba" >times.txt
	for i in 1 2; do oiiotool m.$i.pfm -d float -o m.$i.exr; done
	blocks m G >m.blocks
	against block m.blocks ref.blocks >agree.lines
	awk -F'\t' -v s="$1" -v best="$(cat best)" '
		$1 == "whole" { theirs = $3; ours = $2; z = ($3 - $2) / $4; next }
		{ d += ($3 - $2)^2; v += $4^2; n++; w += $2 }
		END {
			r = sqrt(d / v); k = 100 * sqrt(n) / w
			ok = r <= 1.2 && z <= 4 && z >= -4
			printf "%s: Mitsuba (%s) and vrender agree: means %.5f and %.5f, %.1f standard errors apart", s, best, theirs, ours, z
			printf "; blocks differ by %.2f %% rms, by noise %.2f %%: %.3f, required 1.2\n", k * sqrt(d), k * sqrt(v), r
			exit !ok
		}' agree.lines >line && ok=0 || ok=1
	judge "$ok" "$(cat line)"
}

: >rows
for here in $scenes; do
	case $here in isotropic | c1) transport=continuous ;; *) transport=grid ;; esac
	seconds=${BENCH_SECONDS:-4}
	# few paths that meet the sun within its forward peak, a thousand times as bright as the others, make up the variance
	[ "$here" != c1 ] || seconds=$((4 * seconds))
	samples=$(samples_for $((12 * seconds)) vrender "$here.scene" --transport $transport)
	twice ref "$here.scene" 1001 --samples "$samples" --transport $transport --threads 1
	for i in 1 2; do oiiotool ref.$i.exr --ch G -d float -o ref.$i.exr; done
	oiiotool ref.1.exr ref.2.exr --add --mulc 0.5 -d float -o ref.exr
	own=$(imgcmp --channels G --rms 99 ref.1.exr ref.2.exr | awk '$1 == "G" { print $3 / 4 }')
	blocks ref G >ref.blocks
	awk '{ m += $1; v += $2 } END { printf "%.6f %.2g\n", m / NR, sqrt(v) / NR }' ref.blocks >mean.txt
	read -r mean error <mean.txt
	echo "$here: reference of 2 x $samples samples, mean $mean +- $error, its own relMSE $own"
	case $here in
	isotropic) known 0.36437 0.00006 ;;
	c1) known 0.2837 0.0003 ;;
	esac
	for path in scalar v2 v3 v4; do
		MOTES_CPU=$path
		export MOTES_CPU
		ours "$here" vrender "c, MOTES_CPU=$path, $transport" --transport $transport
	done
	unset MOTES_CPU
	vrender "$here.scene" --transport $transport --backend opencl --samples 1 -o warm.exr
	ours "$here" vrender "opencl, $transport" --transport $transport --backend opencl
	for v in $variants; do theirs "$here" "$v"; done
	[ -z "$variants" ] || agree "$here"
done

# ---- the table, what is required, the chart

longest rows >last
awk -F'\t' -v OFS='\t' '
	NR == FNR { if ($2 == "Mitsuba") { if ($7 > all[$1]) all[$1] = $7; if ($3 !~ /tuned/ && $7 > plain[$1]) plain[$1] = $7 } next }
	FNR == 1 { print "# scene", "renderer", "configuration", "samples", "CPU s", "relMSE", "efficiency", "|z|", "ratio", "ratio_tuned" }
	{ print $0, plain[$1] ? sprintf("%.3g", $7 / plain[$1]) : "-", all[$1] ? sprintf("%.3g", $7 / all[$1]) : "-" }' last rows >render.tsv
cp render.tsv "$out"
cat render.tsv
if [ -n "$variants" ]; then
	for here in $scenes; do
		case $here in isotropic) need=120 aim=200 ;; c1) need=100 aim=200 ;; cloud) need=50 aim=80 ;; sparse) need=100 aim=200 ;; esac
		longest render.tsv | awk -F'\t' -v s="$here" -v need="$need" -v aim="$aim" '
			$1 == s && $2 == "vrender" && $9 > most { most = $9; tuned = $10; best = $3 }
			END {
				printf "%s: %s is %.3gx as efficient as Mitsuba, required %d, aim %d", s, best, most, need, aim
				printf " (%.3gx as its tuned best)\n", tuned
				exit !(most >= need)
			}' >line && ok=0 || ok=1
		judge "$ok" "$(cat line)"
	done
fi
if ! command -v gnuplot >/dev/null; then
	echo 'bench: render: no charts without gnuplot (make deps)' >&2
	exit $failed
fi
# one block of data a line of the chart: Mitsuba's best configuration of a scene, its others, ours
for here in $scenes; do
	awk -F'\t' -v s="$here" '
		$1 == s {
			key = $2 " " $3
			if (!(key in t)) { order[++n] = key; them[key] = $2 == "Mitsuba" }
			t[key] = t[key] $5 " " $6 "\n"
			if (them[key] && $7 > most) { most = $7; best = key }
		}
		END {
			for (i = 1; i <= n; i++) {
				k = order[i]
				printf "\"%s %s\"\n%s\n\n", !them[k] ? "ours" : k == best ? "best" : "other", k, t[k]
			}
		}' rows >"$here.dat"
done
{
	cat <<-'EOT'
	set logscale xy
	set grid back lc rgb "#dddddd"
	set format "%g"
	set xlabel "seconds of CPU time"
	set ylabel "relMSE"
	set key outside right top reverse Left font ",8"
	EOT
	echo "set multiplot layout $(echo "$scenes" | wc -w),1"
	for here in $scenes; do
		echo "set title '$here: error against time, one thread'"
		awk -v file="$here.dat" '
			/^"/ { gsub(/"/, ""); kind = $1; sub(/^[^ ]* /, "")
				style = kind == "ours" ? "lw 2 pt 7 ps 0.6 lc " ++mine : kind == "best" ? "lw 3 pt 5 ps 0.7 lc rgb \"black\"" : \
					"lw 1 pt 4 ps 0.4 lc rgb \"#aaaaaa\""
				title = kind != "other" ? "title \"" $0 "\"" : others++ ? "notitle" : "title \"Mitsuba, other configurations\""
				printf "%s \"%s\" index %d using 1:2 with linespoints %s %s", i ? "," : "plot", file, i++, style, title }
			END { print "" }' "$here.dat"
	done
	echo 'unset multiplot'
} >render.gp
for kind in 'png pngcairo' 'svg svg'; do
	size=1000,$((380 * $(echo "$scenes" | wc -w)))
	gnuplot -e "set terminal ${kind#* } noenhanced size $size font 'sans,11' background '#ffffff'; set output 'render.${kind% *}'" render.gp
done
cp render.png render.svg "$out"
exit $failed
