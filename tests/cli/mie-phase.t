#!/bin/sh
# mie-phase: all angles at once against the direct sum, the angles it chooses, and what it refuses.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"

# apart A B: the largest difference of amplitudes, in units of the largest amplitude in A.
apart() {
	tabtxt --columns s1_re,s1_im,s2_re,s2_im "$1" >apart.a
	tabtxt --columns s1_re,s1_im,s2_re,s2_im "$2" | paste apart.a - | awk '
		NR > 1 {
			for (i = 1; i <= 4; i++) {
				d = $i - $(i + 4); s = $i
				if (d < 0) d = -d; if (s < 0) s = -s
				if (d > worst) worst = d; if (s > top) top = s
			}
		}
		END { print (NR > 1 && top > 0 ? worst / top : 99) }'
}
within() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a <= b) }'; }

# error TABLE FINE: half the integral of |p - fine| over the sphere, p linear between its angles; fine in equal steps.
error() {
	tabtxt --columns theta,p "$1" >error.table
	tabtxt --columns theta,p "$2" >error.fine
	awk '
		FILENAME == "error.table" { if (FNR > 1) { t[n] = $1; p[n++] = $2 }; next }
		FNR > 1 {
			while (i + 2 < n && t[i + 1] < $1) i++
			d = p[i] + (p[i + 1] - p[i]) * ($1 - t[i]) / (t[i + 1] - t[i]) - $2
			sum += (d < 0 ? -d : d) * sin($1 * pi / 180)
			steps = FNR - 2
		}
		BEGIN { pi = atan2(0, -1); i = 0 }
		END { printf "%.6g\n", pi * sum * pi / steps }' error.table error.fine
}
rows() { tabtxt --columns theta "$1" | sed 1d | wc -l; }

# Both ways give the same, which way being a matter of time alone.
for m in 1.33 1.5+0.1i 0.75; do
	mie-phase --particle $m --size-parameter 2000.3 --angles 9001 -o fast.tab
	mie-phase --particle $m --size-parameter 2000.3 --angles 9001 --direct -o direct.tab
	e=$(apart direct.tab fast.tab)
	within "$e" 1e-12
	ok $? "m = $m: all angles at once and the direct sum differ by $e"
	awk -v a="$e" 'BEGIN { exit !(a > 0) }'
	ok $? 'and are two ways indeed'
done
# A weak sphere: what comes back is 7e-9 of what goes forward.
mie-phase --particle 1.01+0.01i --size-parameter 1e6 --angles 2001 | tabtxt --columns s1_re,s1_im,s2_re,s2_im | tail -n 1 >a
mie-phase --particle 1.01+0.01i --size-parameter 1e6 --theta 180 | tabtxt --columns s1_re,s1_im,s2_re,s2_im | tail -n 1 >b
e=$(paste a b | awk '{ print (NF == 8 ? sqrt((($1 - $5)^2 + ($2 - $6)^2 + ($3 - $7)^2 + ($4 - $8)^2) / ($5^2 + $6^2 + $7^2 + $8^2)) : 99) }')
within "$e" 1e-10
ok $? "all angles at once and the direct sum differ by $e of themselves straight back"
mie-phase --particle 1.33 --size-parameter 2000.3 --theta 0:180:0.02 -o list.tab
mie-phase --particle 1.33 --size-parameter 2000.3 --theta 0:180:0.02 --direct -o summed.tab
tabtxt list.tab >a
tabtxt summed.tab | cmp -s - a
ok $? 'a list of angles is always summed'
mie-coeffs --particle 1.33 --size-parameter 2000.3 | mie-phase --angles 9001 -o streamed.tab
mie-phase --particle 1.33 --size-parameter 2000.3 --angles 9001 | tabtxt >a
tabtxt streamed.tab >b
cmp -s a b
ok $? 'from coefficients, too'
mie-phase --particle 1.33 --size-parameter 3000 --angles 40001 --threads 1 | cksum >one
mie-phase --particle 1.33 --size-parameter 3000 --angles 40001 --threads 3 | cksum >three
is "$(cat one)" "$(cat three)" 'the same bytes with 1 and 3 threads'
differ=
for cpu in $(cpus); do
	MOTES_CPU=$cpu mie-phase --particle 1.33 --size-parameter 3000 --angles 40001 -o "$cpu.tab" && cmp scalar.tab "$cpu.tab" || differ="$differ $cpu"
done
is '' "$differ" 'and on every processor'

# The default angles: p is linear between them within the tolerance, with few of them.
while read -r m x most; do
	mie-phase --particle "$m" --size-parameter "$x" -o default.tab
	steps=$(awk -v x="$x" 'BEGIN { print int(60 * x + 4000) }')
	mie-phase --particle "$m" --size-parameter "$x" --angles $((steps + 1)) -o fine.tab
	e=$(error default.tab fine.tab)
	within "$e" 0.001005 && [ "$(rows default.tab)" -le "$most" ]
	ok $? "x = $x, m = $m: $(rows default.tab) angles, at most $most, error $e"
done <<END
1.33 1e-3 181
1.5 10 260
1.33 300.49 2700
1.33 1000.49 7700
1.5+0.1i 1000.49 700
END
while read -r host x; do
	mie-phase --particle 1.5 --host "$host" --size-parameter "$x" -o default.tab
	mie-phase --particle 1.5 --host "$host" --size-parameter "$x" --angles 20001 --direct -o fine.tab
	e=$(error default.tab fine.tab)
	within "$e" 0.001005
	ok $? "x = $x in a host $host: $(rows default.tab) angles, error $e"
done <<END
1.33+0.01i 100.49
1.33+0.1i 300.49
0.05+3i 1
END
for t in 1e-2 1e-4; do
	mie-phase --particle 1.33 --size-parameter 100.49 --tolerance $t -o default.tab
	mie-phase --particle 1.33 --size-parameter 100.49 --angles 20001 --direct -o fine.tab
	e=$(error default.tab fine.tab)
	within "$e" $t
	ok $? "--tolerance $t: $(rows default.tab) angles, error $e"
	rows default.tab >rows.$t
done
[ "$(cat rows.1e-2)" -lt "$(cat rows.1e-4)" ]
ok $? 'and a looser one takes fewer'

# GOA+ where it meets the tolerance and is cheaper, and that is said.
sphere() { mie-phase --particle 1.33 --size-parameter 30000.49 --verbose "$@" 2>said; }
l1() {    # of two tables at equally spaced angles
	tabtxt --columns theta,p "$1" >l1.a
	tabtxt --columns p "$2" | paste l1.a - | awk '
		NR > 1 { d = $2 - $3; sum += (d < 0 ? -d : d) * sin($1 * pi / 180) }
		BEGIN { pi = atan2(0, -1) }
		END { print (NR > 2 ? sum * pi * pi / (NR - 2) : 99) }'
}
sphere --angles 1801 --direct -o direct.tab
for t in 1e-2 0.1; do
	sphere --angles 1801 --tolerance $t -o rough.tab
	is 'mie-phase: verbose: x = 30000.49: method goa+, estimated error 0.005' "$(grep verbose said)" "--tolerance $t takes GOA+ for x = 30000.49"
	e=$(l1 rough.tab direct.tab)
	within "$e" 0.005 && within 1e-9 "$e"
	ok $? "which is off by $e"
done
sphere --angles 1801 --tolerance 1e-6 -o close.tab
is 'mie-phase: verbose: x = 30000.49: method mie, estimated error 1e-07' "$(grep verbose said)" '--tolerance 1e-6 does not'
e=$(l1 close.tab direct.tab)
within "$e" 1e-6
ok $? "and is off by $e"
sphere --angles 1801 -o plain.tab
e=$(apart direct.tab plain.tab)
within "$e" 1e-12
ok $? "nor is it taken unasked ($e)"
while read -r what options; do
	# shellcheck disable=SC2086
	sphere $options -o out.tab
	is 'mie-phase: verbose: method mie for all sizes' "$(grep verbose said)" "nor with $what"
done <<END
--direct --angles 19 --tolerance 1e-2 --direct
--theta --theta 0:180:10 --tolerance 1e-2
END
mie-coeffs --particle 1.33 --size-parameter 30000.49 -o coeffs.tab
mie-phase --angles 19 --tolerance 1e-2 --verbose coeffs.tab -o out.tab 2>said
is 'mie-phase: verbose: method mie for all sizes' "$(grep verbose said)" 'nor for coefficients'
mie-phase --particle 1.5 --host 1.33+1e-6i --size-parameter 30000.49 --angles 19 --tolerance 1e-2 --verbose -o out.tab 2>said
is 'mie-phase: verbose: x = 30000.49: method mie, estimated error 0.001' "$(grep verbose said)" 'nor in a host that absorbs'

# A size is computed alike among others, by any number of threads.
drops() { mie-phase --particle water --angles 91 --tolerance 1e-2 --verbose "$@"; }
for n in 1 2; do
	drops --wavelength 500nm,600nm --radius 100um:4mm:5 --threads $n -o drops.$n 2>said.$n
	cksum <drops.$n >sum.$n
done
is "$(cat sum.1 said.1)" "$(cat sum.2 said.2)" 'the same bytes with 1 and 2 threads, and the same said'
is '4 goa+, 6 mie' "$(grep -c 'goa+' said.1) goa+, $(grep -c 'mie, ' said.1) mie" 'both methods in one table'
drops --wavelength 600nm --radius 4mm 2>said | tabtxt | sed 1d >alone
tabtxt drops.1 | tail -91 | cmp -s - alone
ok $? 'and the last size as it is alone'

# The mean over sizes has angles of its own.
psd lognormal --median 3um --gsd 1.2 --classes 12 -o sizes.psd
mie-phase --particle 1.33 --wavelength 500nm --average sizes.psd -o mean.tab
mie-phase --particle 1.33 --wavelength 500nm --average --angles 8001 sizes.psd -o fine.tab
e=$(error mean.tab fine.tab)
within "$e" 0.001005 && [ "$(rows mean.tab)" -lt 700 ]
ok $? "--average: $(rows mean.tab) angles, error $e"
mie-phase --particle 1.33 --wavelength 450nm,650nm --average sizes.psd | tabtxt --columns wavelength,theta >out
is 1 "$(awk 'NR > 1 { a[$1] = a[$1] " " $2 } END { for (w in a) print a[w] }' out | uniq | wc -l)" 'one grid for all wavelengths of a mean'
for n in 1 3; do mie-phase --particle 1.33 --wavelength 450nm,650nm --average --threads $n sizes.psd | cksum >threads.$n; done
is "$(cat threads.1)" "$(cat threads.3)" 'the mean: the same bytes with 1 and 3 threads'
for n in 1 3; do mie-phase --particle 1.33 --wavelength 450nm,650nm --threads $n sizes.psd | cksum >threads.$n; done
is "$(cat threads.1)" "$(cat threads.3)" 'and size by size'

# Classes with limits are integrated: as by many classes that stand for themselves, not as by their own radii.
average() { mie-phase --particle water --wavelength 550nm --average "$@"; }
for d in 'lognormal --median 5um --gsd 1.2' 'gamma --effective-radius 6um --effective-variance 0.1'; do
	# shellcheck disable=SC2086
	{
		psd $d -o coarse.psd
		psd $d --classes 3001 | tabtxt --columns radius,weight | txttab -o many.psd
	}
	tabtxt --columns radius,weight coarse.psd | txttab -o radii.psd
	average --angles 8001 many.psd -o fine.tab
	for t in 1e-2 1e-3; do
		average --tolerance $t coarse.psd -o mean.tab
		e=$(error mean.tab fine.tab)
		within "$e" $t
		ok $? "$d: the mean within $t ($e)"
	done
	average radii.psd -o mean.tab
	e=$(error mean.tab fine.tab)
	within 0.01 "$e"
	ok $? "which 16 radii are not ($e)"
	average --angles 181 coarse.psd | tabtxt --columns p | sed -n 92p >a
	average --theta 90 coarse.psd | tabtxt --columns p | sed -n 2p >b
	is "$(cat a)" "$(cat b)" 'p does not depend on the other angles'
done
tabtxt coarse.psd >text
{ sed -n 1p text; sed 1d text | sort -r; } | txttab | average --verbose -o turned.tab 2>err
average -o straight.tab coarse.psd
tabcmp --rel 1e-9 straight.tab turned.tab >diff.txt 2>&1
ok $? 'the order of classes does not matter'
is 1 "$(grep -c '^mie-phase: verbose: means over [0-9]* sizes in all; estimated error at most [0-9.e-]*$' err)" '--verbose says how many sizes it took'
for n in 16 801; do
	psd lognormal --median 5um --gsd 1.2 --classes $n | tabtxt >text
	case $n in 801) cut -f1,2 text ;; *) cat text ;; esac | txttab |
		mie-phase --particle 1.5 --host 1.33+0.01i --wavelength 550nm --average --angles 3601 -o host.$n
done
e=$(error host.16 host.801)
within "$e" 1e-3
ok $? "in a host that absorbs as well ($e)"
psd mono --radius 5um | average -o one.tab
mie-phase --particle water --wavelength 550nm --radius 5um --tolerance 5e-4 -o single.tab
e=$(error one.tab single.tab)
within "$e" 1e-3
ok $? "a class without width is one size ($e)"
printf '# radius:f64:um\tweight:f64:1\tradius_lo:f64:um\tradius_hi:f64:um\n5\t1\t5.5\t6\n' | txttab -o bad.tab
refused 'a radius outside its class' 'bad.tab: radius 5 um does not lie between' average bad.tab

# medium-bake takes what comes.
xsect --particle 1.33 --wavelength 450nm,650nm sizes.psd -o sizes.xsect
mie-phase --particle 1.33 --wavelength 450nm,650nm sizes.psd -o sizes.phase
medium-bake --xsect sizes.xsect --phase sizes.phase --psd sizes.psd --concentration 1e6/m3 --box 1m,1m,1m -o out.medium
ok $? 'a medium of these tables'

refused 'a processor that does not exist' "MOTES_CPU: 'v9' is none of" env MOTES_CPU=v9 mie-phase --particle 1.33 --size-parameter 10
refused 'a tolerance out of reach' '--tolerance: .*1e-06.*0.1' mie-phase --particle 1.33 --size-parameter 10 --tolerance 1e-9
done_testing
