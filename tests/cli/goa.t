#!/bin/sh
# goa-phase: rows, columns, normalisation, averages, and what it refuses.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"

drop='--particle 1.33 --wavelength 550nm'
# shellcheck disable=SC2086
phase() { goa-phase $drop "$@"; }

# integral: of p over the sphere by the trapezoidal rule, from theta and p.
integral() {
	tabtxt --columns theta,p | awk 'NR > 1 { t = $1 * atan2(0, -1) / 180; f = $2 * sin(t) * 2 * atan2(0, -1)
		if (NR > 2) s += (f + g) / 2 * (t - u); g = f; u = t } END { printf "%.3f\n", s }'
}

phase --radius 20um --angles 7 | tabtxt >out
is '# wavelength:f64:um	radius:f64:um	theta:f64:deg	s1_re:f64:1	s1_im:f64:1	s2_re:f64:1	s2_im:f64:1	p:f64:sr^-1' \
	"$(head -1 out)" 'columns'
is 8 "$(wc -l <out)" 'a row for each angle'
is '0 30 60 90 120 150 180' "$(awk 'NR > 1 { print $3 }' out | tr '\n' ' ' | sed 's/ $//')" 'equally spaced'
phase --radius 10um,20um --theta 0:180:45 | tabtxt --columns radius,theta >out
is 11 "$(wc -l <out)" 'every angle of every size'
is '20	180' "$(tail -1 out)" 'size by size'
goa-phase --particle 1.33 --size-parameter 1000.5 --theta 90 | tabtxt >out
is '# x:f64:1' "$(head -1 out | cut -f1)" 'by size parameter'
is 1000.5 "$(tail -1 out | cut -f1)" 'which is taken exactly'
goa-phase --particle 1.5 --host 1.25 --wavelength 550nm --radius 20um --theta 33 | tabtxt --columns s1_re >a
goa-phase --particle 1.2 --wavelength 440nm --radius 20um --theta 33 | tabtxt --columns s1_re >b
is "$(awk 'NR > 1 { printf "%.6g", $1 }' b)" "$(awk 'NR > 1 { printf "%.6g", $1 }' a)" 'only the relative index and x matter'

# p and its norm.
one() {    # INTEGRAL TOLERANCE NAME
	awk -v v="$1" -v t="$2" 'BEGIN { exit !(v > 1 - t && v < 1 + t) }'
	ok $? "$3, within $2 ($1)"
}
for m in 1.33 1.5+0.1i 0.75; do
	one "$(goa-phase --particle "$m" --size-parameter 300 --angles 20001 | integral)" 0.007 "m = $m: p integrates to 1"
done
one "$(goa-phase --particle 1.33 --size-parameter 300 | integral)" 0.007 'and on the default grid'
phase --radius 20um --theta 17 | tabtxt --columns p >a
phase --radius 20um --theta 0:180:1 | tabtxt --columns theta,p | awk '$1 == 17 { print $2 }' >b
is "$(tail -1 a)" "$(cat b)" 'p does not depend on the other angles'
phase --radius 20um --theta 40 | tabtxt --columns s1_re,s1_im,s2_re,s2_im |
	awk 'NR > 1 { printf "%.3f %.3f %.3f %.3f\n", $1, $2, $3, $4 }' >a
phase --radius 20um --theta 40 --order 3 --model goa | tabtxt --columns s1_re,s1_im,s2_re,s2_im |
	awk 'NR > 1 { printf "%.3f %.3f %.3f %.3f\n", $1, $2, $3, $4 }' >b
is "$(cat a)" "$(cat b)" 'order 3 and the published model are the default'
# Diffraction in the forward direction is x^2/2 real, the reflected ray x/2 everywhere.
goa-phase --particle 1.33 --size-parameter 1000 --theta 0 --order 0 | tabtxt --columns s1_re |
	awk 'NR > 1 { exit !($1 > 499000 && $1 < 501000) }'
ok $? 'x^2/2 forward'
goa-phase --particle 1.33 --size-parameter 1000 --theta 180 --order 0 | tabtxt --columns s1_re,s1_im |
	awk 'NR > 1 { r = sqrt($1^2 + $2^2) / 500; exit !(r > 0.33 / 2.33 - 1e-9 && r < 0.33 / 2.33 + 1e-9) }'
ok $? 'x/2 times Fresnel backward'

# Near Mie for a large drop: a few percent of the light goes elsewhere.
goa-phase --particle 1.33 --size-parameter 1000.49 --angles 7201 | tabtxt --columns theta,p >a
mie-phase --particle 1.33 --size-parameter 1000.49 --angles 7201 | tabtxt --columns p >b.mie
paste a b.mie | awk 'NR > 1 { d = $2 - $3; s += (d < 0 ? -d : d) * sin($1 * atan2(0, -1) / 180) }
	END { s *= atan2(0, -1)^2 / 7200; print "# L1", s; exit !(s > 0.028 && s < 0.038) }'
ok $? 'L1 against Mie'

# Tables in, columns carried, averages.
printf '# radius:f64:um\tweight:f64:1\n20\t0.25\n40\t0.75\n' | txttab -o sizes.tab
phase --theta 0,180 sizes.tab | tabtxt --columns radius,theta,weight >out
is '20	0	0.25
20	180	0.25
40	0	0.75
40	180	0.75' "$(tail -n +2 out)" 'weights are carried through'
phase --theta 0,180 <sizes.tab | tabtxt --columns radius,theta,weight >out2
is "$(cat out)" "$(cat out2)" 'from standard input too'
phase --average --angles 20001 sizes.tab | tabtxt >out
is '# wavelength:f64:um	theta:f64:deg	p:f64:sr^-1' "$(head -1 out)" 'an average has no radius'
is 20002 "$(wc -l <out)" 'and one row an angle'
one "$(txttab out | integral)" 0.007 'and integrates to 1'

# The same bytes, whatever the threads.
goa-phase --particle water --wavelength 400nm,500nm,600nm --radius 5um:30um:4 --threads 1 -o one.tab
goa-phase --particle water --wavelength 400nm,500nm,600nm --radius 5um:30um:4 --threads 3 -o three.tab
cmp -s one.tab three.tab
ok $? 'one and three threads'

# Where GOA does not hold it says so once, and goes on.
goa-phase --particle 1.49 --size-parameter 1.047,1.2,1.3 --theta 0,90 >out.tab 2>err
is "0 1" "$? $(wc -l <err)" 'one warning'
grep -q 'goa-phase: geometrical optics does not hold at x = ' err
ok $? 'that names x'
is 7 "$(tabtxt out.tab | wc -l)" 'and all rows'
phase --radius 20um --theta 1 -o out.tab 2>err
is 0 "$(wc -c <err)" 'silent on success'
goa-phase --particle 1.33 --size-parameter 1e-8,1e7 --order 12 --theta 0,90,137.9,180 2>err | tabtxt >out
is "9 0" "$(wc -l <out) $(grep -cE 'nan|inf' out)" 'finite from end to end'

# GOA+.
for m in 1.33 1.5+0.1i 0.75; do
	one "$(goa-phase --model goa+ --particle "$m" --size-parameter 300 --angles 20001 | integral)" 0.002 "goa+, m = $m: p integrates to 1"
done
goa-phase --model goa+ --particle 1.33 --size-parameter 1000.49 --angles 7201 | tabtxt --columns theta,p >a
paste a b.mie | awk 'NR > 1 { d = $2 - $3; s += (d < 0 ? -d : d) * sin($1 * atan2(0, -1) / 180) }
	END { s *= atan2(0, -1)^2 / 7200; print "# L1", s; exit !(s < 2.5e-3) }'
ok $? 'goa+: L1 against Mie'
# Both axes, rainbows to the last digit (p = 2, 3 of 1.33; p = 2 of 1.5), glories (1.7).
axes() {
	goa-phase --model goa+ --particle "$1" --size-parameter "$2" --theta "$3" | tabtxt --columns theta,p >a
	mie-phase --particle "$1" --size-parameter "$2" --theta "$3" | tabtxt --columns p >b
	paste a b | awk 'NR > 1 { r = $2 / $3; if (!(r > 0.9 && r < 1.1)) { print "# theta", $1, "off by", r; bad = 1 } } END { exit bad || NR < 3 }'
}
axes 1.33 1000.49 0,1e-7,0.001,179.999,179.9999999,180
ok $? 'on and beside the axes'
axes 1.33 10000.49 0,137.92189,137.9218,129.1086,180
ok $? 'on rainbows of water'
axes 1.7 5000.3 0,1e-6,0.01,179.98,179.99999,180
ok $? 'in a glory'
axes 0.75 3000.3 0,1e-6,0.01,179.98,179.99999,180
ok $? 'and in those of a bubble'
axes 2 1000.3 0,0.1,179.9,180
ok $? 'an index that focuses on the back'
goa-phase --model goa+ --particle 1.33 --size-parameter 0.01,0.1,1,1e7 --theta 0,90,137.9,180 2>err | tabtxt >out
is "17 0" "$(wc -l <out) $(grep -cE 'nan|inf' out)" 'finite from end to end'

# 4 digits: what another libm may round otherwise is far below.
for model in goa goa+ incoherent; do
	goa-phase --model $model --particle 1.33 --size-parameter 1000.49 --theta 0,1,30,90,137,139,180 | tabtxt --columns theta,p
	goa-phase --model $model --particle 0.75+0.001i --size-parameter 300.28 --theta 0,1,30,83,120,180 | tabtxt --columns theta,p
done | awk -v OFS='\t' '/^[0-9]/ { $2 = sprintf("%.3e", $2) } 1' >out
golden goa-phase.txt out
phase --model goa+ --average --angles 20001 sizes.tab | tabtxt >out
one "$(txttab out | integral)" 0.007 'averages integrate to 1'

# Without interference nothing but the lobe knows of the size.
goa-phase --model incoherent --particle 1.33 --size-parameter 1000,4000 --theta 60,120,150 | tabtxt --columns theta,p | tail -n +2 >out
head -3 out >a
tail -3 out | paste a - | awk '{ r = $2 / $4; if (!(r > 0.99 && r < 1.01)) bad = 1 } END { exit bad }'
ok $? 'incoherent: the same at any size'
goa-phase --model incoherent --particle 1.33 --size-parameter 300 --theta 120 | tabtxt --columns s1_re,s1_im | awk 'NR > 1 { exit !($1 > 0 && $2 == 0) }'
ok $? 'and its amplitudes are roots of powers'
one "$(goa-phase --model incoherent --particle 1.33 --size-parameter 3000 --angles 20001 | integral)" 0.007 'and its p integrates to 1'

# The same bytes on every processor and with any number of threads.
for model in goa goa+ incoherent; do
	for m in 1.33 0.75+0.001i; do
		differ=
		for cpu in $(cpus); do
			MOTES_CPU=$cpu goa-phase --model $model --particle $m --size-parameter 20,400,3000 --theta 0:180:0.37 -o "$cpu.tab" &&
				cmp scalar.tab "$cpu.tab" || differ="$differ $cpu"
		done
		is '' "$differ" "$model, m = $m: the same bytes on every processor"
	done
done
psd lognormal --median 40um --gsd 1.4 --classes 3 -o drops.psd
differ=
for cpu in $(cpus); do
	MOTES_CPU=$cpu phase --tolerance 1e-2 --theta 0:180:0.37 -o "$cpu.tab" drops.psd && cmp scalar.tab "$cpu.tab" || differ="$differ $cpu"
done
is '' "$differ" 'means: the same bytes on every processor'
# l1 A B: half the integral of |dp|, at its largest over the classes.
l1() {
	tabtxt --columns radius,theta,p "$1" >l1.a && tabtxt --columns p "$2" | paste l1.a - | awk 'NR > 1 {
		t = $2 * atan2(0, -1) / 180; f = ($3 > $4 ? $3 - $4 : $4 - $3) * sin(t) * atan2(0, -1)
		if ($1 == r) s[r] += (f + g) / 2 * (t - u); r = $1; g = f; u = t } END { for (r in s) if (s[r] > most) most = s[r]; print most }'
}
phase --tolerance 1e-4 -o fine.tab drops.psd
for tolerance in 1e-2 1e-3; do
	phase --tolerance $tolerance -o rough.tab drops.psd
	l1 fine.tab rough.tab | awk -v t=$tolerance '{ exit !($1 > 0 && $1 < t) }'
	ok $? "means within $tolerance"
done
goa-phase --model goa+ --particle water --wavelength 400nm,500nm,600nm --radius 5um:30um:4 --threads 1 -o one.tab
goa-phase --model goa+ --particle water --wavelength 400nm,500nm,600nm --radius 5um:30um:4 --threads 3 -o three.tab
cmp -s one.tab three.tab
ok $? 'goa+: one and three threads'

refused 'an order with goa+' '--order: is for goa and incoherent' goa-phase --model goa+ --order 3 --particle 1.33 --size-parameter 100
refused 'a processor that is none' 'MOTES_CPU: .vax. is none of' env MOTES_CPU=vax goa-phase --particle 1.33 --size-parameter 100
refused 'no particle' 'particle' goa-phase --wavelength 550nm --radius 1um
refused 'a negative order' 'order' goa-phase --particle 1.33 --size-parameter 100 --order -1
refused 'a model that is none' 'model' goa-phase --particle 1.33 --size-parameter 100 --model mie
mie-coeffs --particle 1.33 --wavelength 550nm --radius 1um -o coeffs.tab
refused 'coefficients' 'coefficients' goa-phase --particle 1.33 --wavelength 550nm coeffs.tab
done_testing
