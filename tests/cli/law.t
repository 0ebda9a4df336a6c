#!/bin/sh
# The law of a size distribution: it travels with its table, and what does not fit it is refused.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"

law() { sed -n '/^$/q; s/^law	//p' "$1"; }
optics='--particle 1.33 --wavelength 550nm'

psd gamma --effective-radius 1um --effective-variance 0.1 --max 4um --classes 4 -o sizes.tab
want='gamma effective_radius=1 effective_variance=0.1 max=4'
is "$want" "$(law sizes.tab)" 'psd writes its law'
tabtxt sizes.tab >sizes.txt
txttab sizes.txt -o again.tab
is "$want" "$(law again.tab)" 'tabtxt | txttab keeps it'
# shellcheck disable=SC2086
{
	xsect $optics sizes.tab -o out.tab
	is "$want" "$(law out.tab)" 'xsect hands it on'
	xsect $optics --average out.tab | tabtxt --columns c_ext >a
	xsect $optics --average sizes.tab | tabtxt --columns c_ext | cmp -s a -
	ok $? 'and its table is one of sizes still'
	xsect --particle 1.33 --wavelength 500nm,600nm sizes.tab | xsect $optics --average | tabtxt --columns c_ext | cmp -s a -
	ok $? 'also with a row for each wavelength'
	mie-coeffs $optics sizes.tab -o out.tab
	is "$want" "$(law out.tab)" 'so does mie-coeffs'
	mie-phase $optics --theta 0,90,180 sizes.tab -o out.tab
	is "$want" "$(law out.tab)" 'and mie-phase'
	mie-phase $optics --average --theta 0,90,180 sizes.tab -o out.tab
	is "$want" "$(law out.tab)" 'its mean, too'
	is '# wavelength:f64:um radius:f64:um theta:f64:deg p:f64:sr^-1' \
		"$(mie-phase $optics --theta 90 sizes.tab | tabtxt --columns wavelength,radius,theta,p | sed -n '1s/	law=.*//; 1p' | tr '\t' ' ')" 'a class has no amplitudes'
	refused 'amplitudes of a class' 'has no column s1_re' sh -c "mie-phase $optics --theta 90 sizes.tab | tabtxt --columns s1_re"
	is 4 "$(mie-phase $optics --at-radius --theta 90 sizes.tab | tabtxt --columns s1_re | sed 1d | wc -l)" 'its radius has'

	# Without limits rows are sizes, whatever the law says; --at-radius takes them so.
	tabtxt --columns radius,weight sizes.tab | txttab -o radii.tab
	is "$want" "$(law radii.tab)" 'a law without limits stays'
	xsect $optics radii.tab | tabtxt --columns c_ext >a
	xsect $optics --at-radius sizes.tab | tabtxt --columns c_ext | cmp -s a -
	ok $? 'and leaves rows as they are'

	# A table of one's own says what its classes leave open.
	sed '1s/	law=.*//' sizes.txt | txttab -o own.tab
	xsect $optics own.tab 2>err >own.xsect
	is 1 "$(grep -c 'xsect: own.tab: means over sizes are uncertain by .*classes' err)" 'classes without a law leave something open'
	mie-phase $optics --average own.tab 2>err >own.phase
	is 1 "$(grep -c 'mie-phase: own.tab: means over sizes are uncertain by .*classes' err)" 'in phase functions, too'
	for n in 4 16; do
		psd gamma --effective-radius 1um --effective-variance 0.1 --max 4um --classes $n | tabtxt | sed '1s/	law=.*//' | txttab |
			xsect $optics --average 2>/dev/null | tabtxt --columns c_ext,error | sed 1d
	done >off
	xsect $optics --average sizes.tab | tabtxt --columns c_ext | sed 1d >truth
	awk 'NR == FNR { c = $1; next } { d = $1 / c - 1; if (d < 0) d = -d; bad += d > $2 } END { exit bad || NR != 3 }' truth off
	ok $? "which is more than they are off ($(tr '\n\t' '; ' <off))"
}

# What does not fit, by everyone who reads it.
xsect --particle 1.33 --wavelength 550nm sizes.tab -o x.xsect
mie-phase --particle 1.33 --wavelength 550nm --average sizes.tab -o x.phase
bad() {
	name=$1 match=$2
	txttab bad.txt -o bad.tab
	# shellcheck disable=SC2086
	{
		refused "$name: xsect" "bad.tab: the law .*$match" xsect $optics bad.tab
		refused "$name: mie-phase" "bad.tab: the law .*$match" mie-phase $optics --average bad.tab
		refused "$name: goa-phase" "bad.tab: the law .*$match" goa-phase $optics --average bad.tab
	}
	refused "$name: particles" "bad.tab: the law .*$match" particles --psd bad.tab --count 10 --box 1m,1m,1m
	refused "$name: medium-bake" "bad.tab: the law .*$match" medium-bake --xsect x.xsect --phase x.phase --psd bad.tab --concentration 1/cm3 \
		--box 1m,1m,1m -o bad.medium
}
sed '1s/radius=1/radius=1.01/' sizes.txt >bad.txt
bad 'another law' 'does not fit the rows: weights are not its fractions'
sed '1s/radius=1/radius=nan/' sizes.txt >bad.txt
bad 'a law with a NaN' 'no number'
awk -F'\t' -v OFS='\t' 'NR == 3 { $3 *= 1.01 } 1' sizes.txt >bad.txt
bad 'limits that do not touch' 'does not fit the rows: the limits of classes do not touch'
sed '1s/max=4/max=5/' sizes.txt >bad.txt
bad 'a cut elsewhere' 'cut where the classes do not end'
sed '1s/gamma/gauss/' sizes.txt >bad.txt
bad 'no distribution' 'is no distribution'
sed 3d sizes.txt >bad.txt
bad 'a class that is missing' 'the limits of classes do not touch'
awk -F'\t' -v OFS='\t' 'NR == 3 { $1 = $4 * 2 } 1' sizes.txt | txttab -o bad.tab
# shellcheck disable=SC2086
refused 'a radius outside its limits' 'bad.tab: radius .* does not lie between' xsect $optics bad.tab
{ sed '1s/$/	law=mono radius=1/' sizes.txt; } >bad.txt
refused 'two laws' 'line 1: a law stands twice' txttab bad.txt
done_testing
