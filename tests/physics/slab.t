#!/bin/sh
# Slabs and half spaces against discrete ordinates and Chandrasekhar; a thin slab against its closed form. All of them, and eight ten
# times as exactly: tests/bench/slab.sh.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/media.sh
. "$top/tests/support/media.sh"
for g in 0 0.5 0.75 0.875; do hg $g >hg$g.phase; done
seed=0      # from one value to the next it goes on by 2; never chosen

# value WHAT WANT ERROR SCENE [OPTION..]: a line for zs
value() {
	what=$1 want=$2 error=$3
	shift 3
	scene=$1
	shift
	# shellcheck disable=SC2046
	set -- $(seen "$scene" "$error" $seed "$@")
	printf '%s\t%s\t%s\t%s\n' "$what" "$want" "$1" "$2"
}

# 16 rows, at a standard error of 1e-3. Every fourth in the grid. T below 0.002 is left out: its paths are too few to know their
# spread. False alarm: |z| > 5 in any of some 44 values below 3e-5, the rms beyond 4.1 standard deviations below 5e-5.
while IFS=, read -r g tau albedo mu0; do
	row=$(grep "^$g,$tau,$albedo,$mu0," "$data/slab_reflectance_hg.csv")
	t=${row#"$g,$tau,$albedo,$mu0,"}
	r=${t%%,*} t=${t#*,}
	t=${t%%,*}
	slab s.medium "$tau" "$albedo" "hg$g.phase"
	[ $((seed % 16)) -eq 12 ] && transport=grid || transport=continuous
	for q in "R $r -1" "T $t 1"; do
		# shellcheck disable=SC2086
		set -- $q
		seed=$((seed + 2))
		look s.scene s.medium "$mu0" "$(half_sky "$3")"
		awk -v x="$2" 'BEGIN { exit x >= 0.002 }' ||
			value "$1 of g $g, tau $tau, albedo $albedo, mu0 $mu0, $transport" "$2" 1e-3 s.scene --transport "$transport"
	done
done >slabs <<'EOT'
0,0.25,0.5,0.1
0,1,0.9,0.5
0,2,0.99,1.0
0,4,0.5,1.0
0,8,0.9,0.1
0.5,0.25,0.99,0.5
0.5,1,0.999999,1.0
0.5,4,0.9,0.5
0.5,2,0.99,0.1
0.75,1,0.9,1.0
0.75,2,0.999999,1.0
0.75,4,0.99,0.5
0.75,8,0.9,0.5
0.875,0.25,0.99,1.0
0.875,1,0.99,1.0
0.875,8,0.99,0.1
EOT
zs 5 4.1 <slabs >told
ok $? "slabs: $(cat told)"

# Half spaces: isotropic slabs so deep that e^(-2 k tau) is below 1e-6; with albedo 1, where no depth would do, the asymptotic law
# for what a deep slab reflects less, H(1) H(mu0) mu0/(4 (tau + 1.42089)) of light of irradiance pi straight up.
half() { # ALBEDO TAU MU0
	IFS=, read -r albedo mu0 h plane _ radiance <<-EOT
	$(grep "^$1,$3," "$data/halfspace_isotropic.csv")
	EOT
	slab s.medium "$2" "$albedo" hg0.phase
	if [ "$albedo" != 1.0 ]; then
		look s.scene s.medium "$mu0" "$(half_sky -1)"
		value "plane albedo, albedo $albedo, mu0 $mu0" "$plane" 1e-3 s.scene
	fi
	seed=$((seed + 2))
	look s.scene s.medium 1 "$(beam "$mu0" 3.14159265358979)"
	radiance=$(awk -v a="$albedo" -v r="$radiance" -v h="$h" -v mu="$mu0" -v tau="$2" \
		'BEGIN { printf "%.7f", r - (a == 1 ? 2.907811 * h * mu / 4 / (tau + 1.42089) : 0) }')
	value "radiance, albedo $albedo, mu0 $mu0" "$radiance" 1e-3 s.scene
}
for row in '0.5 16 0.1' '0.9 16 0.5' '0.99 40 0.9' '1.0 16 0.7'; do
	seed=$((seed + 2))
	# shellcheck disable=SC2086
	half $row
done >halves
zs 5 4.1 <halves >told
ok $? "half spaces: $(cat told)"

# A thin slab that scatters so little that what is scattered twice, a part in 10^4 at most, does not count: albedo 1e-4, light of
# irradiance 1e4 pi. Reflected E p mu0/(mu + mu0) (1 - e^(-tau(1/mu + 1/mu0))), let through E p mu0/(mu0 - mu) (e^(-tau/mu0) -
# e^(-tau/mu)), with E here times the albedo. At a standard error of 3e-3 of it.
while read -r side tau mu0 mu; do
	seed=$((seed + 2))
	slab s.medium "$tau" 1e-4 hg0.75.phase
	[ "$side" = up ] && m=$mu0 || m=-$mu0
	look s.scene s.medium "$mu" "$(beam "$m" 31415.9265358979)"
	want=$(awk -v side="$side" -v tau="$tau" -v m0="$mu0" -v m="$mu" 'BEGIN {
		pi = atan2(0, -1); g = 0.75
		c = sqrt((1 - m*m) * (1 - m0*m0)) - (side == "up" ? m * m0 : -m * m0)
		p = (1 - g*g) / (4 * pi * (1 + g*g - 2 * g * c)^1.5)
		printf "%.8g", pi * p * m0 * (side == "up" ? (1 - exp(-tau / m - tau / m0)) / (m + m0) : (exp(-tau / m0) - exp(-tau / m)) / (m0 - m)) }')
	value "$side: tau $tau, mu0 $mu0, mu $mu" "$want" "$(awk -v w="$want" 'BEGIN { print 0.003 * w }')" s.scene
done >thin <<'EOT'
up 0.05 0.5 0.8
up 0.5 0.9 0.3
down 0.05 0.8 0.5
down 0.2 0.3 0.6
EOT
zs 5 4.1 <thin >told
ok $? "thin slabs: $(cat told)"
awk -F'\t' '$4 > 1.2e-3 { exit 1 }' slabs halves
ok $? 'standard errors as asked for'
done_testing
