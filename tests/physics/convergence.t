#!/bin/sh
# Grains converge to the continuous medium as N^(-1/2), and are it in the mean. Up to 10^6 particles: tests/bench/convergence.sh.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/media.sh
. "$top/tests/support/media.sh"
clouds_setup
continuum 512
for t in explicit fat-ray; do
	departs 1000 $t 4 8
	departs 10000 $t 8 8
	departs 100000 $t 16 8
done >lines
# shellcheck disable=SC2046
law $(limit) <lines >laws
sed 's/^/# /' laws
# Slope: 8 clouds of 64 blocks leave 7 % and 10 % of the mean squares at both ends to chance, 0.013 of the slope. The law itself is not
# quite a straight line: discs of 10^3 particles are as large as half a block, which takes 0.025 off explicit, and fat rays
# (A = 7 C at 10^5) spare the squares of overlaps, which adds 0.035. 0.1 is then 5 standard errors: false alarm 1e-6.
# Mean: 6 standard errors pooled over the three N, 21 degrees of freedom: false alarm 6e-6 for each.
for t in explicit fat-ray; do
	awk -v t=$t '$1 == "slope" && $2 == t { n++; d = $3 + 0.5; bad = d > 0.1 || d < -0.1 } END { exit !(n == 1 && !bad) }' laws
	ok $? "$t: rms of blocks against N: slope $(awk -v t=$t '$1 == "slope" && $2 == t { print $3 }' laws)"
	awk -v t=$t '$1 == "slope" && $2 == t { n++; bad = $4 > 6 || $4 < -6 } END { exit !(n == 1 && !bad) }' laws
	ok $? "$t: the mean over clouds is the continuum's"
done
done_testing
