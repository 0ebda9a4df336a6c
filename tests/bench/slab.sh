# shellcheck shell=sh
# Slabs and half spaces, all that tests/data has: the table of discrete ordinates at a standard error of 1e-3, eight values of it at
# 1e-4, Chandrasekhar's half spaces at 1e-3. Prints slab.tsv and a line PASS or FAIL for each of the three.
# T below 0.002 is rendered, but judged by 4.5 times the largest spread that paths of its mean can have, and not in the rms.
# usage, by tests/bench/run: slab.sh OUT
out=$1
bench=$(cd "$(dirname "$0")" && pwd)
data=$bench/../data
# shellcheck source=tests/support/media.sh
. "$bench/../support/media.sh"
for g in 0 0.5 0.75 0.875; do hg $g >hg$g.phase; done
seed=0      # from one value to the next it goes on by 2; never chosen

# value SET WHAT WANT ERROR SCENE: a line of slab.tsv
value() {
	seed=$((seed + 2))
	seen "$5" "$4" $seed >got
	awk -v OFS='\t' -v set="$1" -v what="$2" -v want="$3" '{ print set, what, want, $1, $2, $3 }' got
}
# row SET ERROR QUANTITIES G TAU ALBEDO MU0 R T
row() {
	slab s.medium "$5" "$6" "hg$4.phase"
	for q in $3; do
		[ "$q" = R ] && want=$8 lit=-1 || want=$9 lit=1
		look s.scene s.medium "$7" "$(half_sky "$lit")"
		value "$1" "$q g $4 tau $5 albedo $6 mu0 $7" "$want" "$2" s.scene
	done
}
{
	printf '# set\twhat\twanted\tgot\terror\tsamples\n'
	grep '^[0-9]' "$data/slab_reflectance_hg.csv" | tr , ' ' >rows
	while read -r g tau albedo mu0 r t _; do
		row slab 1e-3 'R T' "$g" "$tau" "$albedo" "$mu0" "$r" "$t"
	done <rows
	# thin, thick, forward, absorbing, conservative; those whose paths are short, a sample costing the least
	while read -r q g tau albedo mu0; do
		grep "^$g $tau $albedo $mu0 " rows >one
		read -r _ _ _ _ r t _ <one
		row exact 1e-4 "$q" "$g" "$tau" "$albedo" "$mu0" "$r" "$t"
	done <<-EOT
		T 0 0.25 0.999999 1.0
		R 0 1 0.9 0.5
		R 0 16 0.5 0.1
		R 0.5 4 0.9 1.0
		T 0.5 2 0.5 0.5
		R 0.75 1 0.999999 0.5
		T 0.875 1 0.99 1.0
		R 0.875 8 0.9 1.0
	EOT
	# deep enough that e^(-2 k tau) is below 1e-6; albedo 1: see tests/physics/slab.t
	grep '^[0-9]' "$data/halfspace_isotropic.csv" | tr , ' ' >rows
	while read -r albedo mu0 h plane _ radiance; do
		case $albedo in 0.99) tau=40 ;; *) tau=16 ;; esac
		slab s.medium $tau "$albedo" hg0.phase
		if [ "$albedo" != 1.0 ]; then
			look s.scene s.medium "$mu0" "$(half_sky -1)"
			value half "plane albedo $albedo mu0 $mu0" "$plane" 1e-3 s.scene
		fi
		look s.scene s.medium 1 "$(beam "$mu0" 3.14159265358979)"
		value half "radiance albedo $albedo mu0 $mu0" "$(awk -v a="$albedo" -v r="$radiance" -v h="$h" -v mu="$mu0" -v tau=$tau \
			'BEGIN { printf "%.7f", r - (a == 1 ? 2.907811 * h * mu / 4 / (tau + 1.42089) : 0) }')" 1e-3 s.scene
	done <rows
} | tee "$out/slab.tsv"

# judge NAME SET LOW HIGH ERROR: see zs; so few values as eight are within 0.15 of 1 by chance only
failed=0
judge() {
	awk -F'\t' -v OFS='\t' -v set="$2" '$1 == set && $3 >= 0.002 { print $2, $3, $4, $5 }' "$out/slab.tsv" >lines
	told=$(zs 4.5 "$3" "$4" <lines) && pass=PASS || pass=FAIL
	largest=$(cut -f 4 lines | sort -g | tail -1)
	awk -v e="$largest" -v limit="$5" 'BEGIN { exit !(e <= limit) }' || pass=FAIL
	echo "$pass $1: $told; largest standard error $largest"
	[ "$pass" = PASS ] || failed=1
}
judge 'slabs' slab 0.85 1.15 1.05e-3
judge 'slabs, exactly' exact 4.1 '' 1.05e-4
judge 'half spaces' half 4.1 '' 1.05e-3
awk -F'\t' '/^#/ || $3 >= 0.002 { next }
	{ n++; d = $4 - $3; if (d * d > 20.25 * ($3 + 5e-7) / $6) bad++ }
	END { print (bad ? "FAIL" : "PASS") " small T: " n " values, " bad + 0 " outside"; exit bad > 0 }' "$out/slab.tsv" || failed=1
exit $failed
