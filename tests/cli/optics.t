#!/bin/sh
# The Lorenz-Mie tools: sizes in, coefficients streamed between them, bad input refused.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"

# Ten digits: what another libm or compiler changes lies far below.
digits() { awk '/^#/ { print; next } { for (i = 1; i <= NF; i++) printf("%s%.10g", i > 1 ? "\t" : "", $i); print "" }'; }

# As psd lognormal --median 10um --gsd 1.4 gives them: 16 radii, weights, and columns of the user's own.
awk 'BEGIN {
	print "# radius:f64:um\tweight:f64:1\tradius_lo:f64:um\tradius_hi:f64:um\ttag:i32:1"
	for (i = 0; i < 16; i++) {
		u = (i - 7.5) / 3
		r = 10 * exp(log(1.4) * u)
		printf "%.17g\t%.17g\t%.17g\t%.17g\t%d\n", r, exp(-u * u / 2), r * 0.95, r * 1.05, 100 + i
	}
}' | txttab >psd.tab
printf '# radius:f64:um\tweight:f64:1\n0.3\t0.75\n1\t0.25\n' | txttab >two.tab
water='--particle 1.33 --wavelength 450nm,550nm,650nm'

# What comes out.
tabtxt two.tab >two.txt
# shellcheck disable=SC2086
xsect --method mie $water two.tab | tabtxt | digits >out
golden xsect.txt out
xsect --method mie --particle 1.5+0.1i --size-parameter 0.01,1,100 | tabtxt | digits >out
golden xsect-x.txt out
for m in 1.33 0.75 1.5+0.1i; do
	for method in rayleigh evans-fournier cam; do
		xsect --method $method --particle $m --size-parameter 0.1,1000 2>err | tabtxt | sed 1d
	done
done | digits >out
golden xsect-methods.txt out
mie-phase --particle 1.33+1e-5i --host 1.1 --wavelength 550nm --radius 0.2um --theta 0:180:45 | tabtxt | digits >out
golden mie-phase.txt out
mie-phase --particle 1.33 --wavelength 450nm,550nm --average --theta 180,0,90 two.tab | tabtxt | digits >out
golden mie-phase-average.txt out
mie-coeffs --particle 1.33 --wavelength 550nm <two.tab | tabtxt | head -4 | digits >out
golden mie-coeffs.txt out
is '# x:f64:1	host_re:f64:1	host_im:f64:1	n:i32:1	a_re:f64:1	a_im:f64:1	b_re:f64:1	b_im:f64:1' \
	"$(mie-coeffs --particle 1.33 --size-parameter 1 | tabtxt | head -1)" 'mie-coeffs by size parameter'

# Coefficients, which are those of a radius, give what is computed at once, but for rounding (c_abs, a difference, to that of c_ext); carried columns travel.
for m in 1.33 1.33+1e-8i 1.5+0.1i; do
	options="--particle $m --wavelength 450nm,550nm,650nm"
	# shellcheck disable=SC2086
	{
		xsect --method mie --at-radius $options psd.tab >direct.tab
		mie-coeffs $options psd.tab | xsect >streamed.tab
		tabcmp --rel 1e-12 --abs 1e-11 direct.tab streamed.tab >diff.txt 2>&1
		is '0 49' "$? $(tabtxt streamed.tab | wc -l)" "mie-coeffs | xsect, $m"
		mie-phase --at-radius $options --angles 37 psd.tab >direct.tab
		mie-coeffs $options psd.tab | mie-phase --angles 37 >streamed.tab
		tabcmp --rel 1e-12 direct.tab streamed.tab >diff.txt 2>&1
		ok $? "mie-coeffs | mie-phase, $m"
	}
done
# shellcheck disable=SC2086
{
	mie-phase --at-radius $water psd.tab >direct.tab
	mie-coeffs $water psd.tab | mie-phase >streamed.tab
	tabcmp direct.tab streamed.tab >diff.txt 2>&1
	ok $? 'on the default grid, too'
	tabtxt --columns radius,weight psd.tab | txttab -o plain.tab    # coefficients say nothing of sizes within a class
	mie-phase $water --average plain.tab >direct.tab
	mie-coeffs $water psd.tab | mie-phase --average >streamed.tab
	tabcmp direct.tab streamed.tab >diff.txt 2>&1
	ok $? 'and averaged'
	mie-coeffs $water psd.tab -o classes.tab
	for tool in xsect 'mie-phase --average --angles 5001'; do
		$tool -o out.tab classes.tab 2>err
		is 1 "$(grep -c 'classes.tab: coefficients of classes are those of their radii alone' err)" "$tool: coefficients give no mean over a class, and a line says so"
		$tool --at-radius -o out.tab classes.tab 2>err
		is '' "$(cat err)" 'unless that is meant'
	done
	psd mono --radius 3um | mie-coeffs $water | xsect -o out.tab 2>err
	is '' "$(cat err)" 'or there are no classes'
}
xsect --method mie --particle 1.5 --size-parameter 1,10 >direct.tab
mie-coeffs --particle 1.5 --size-parameter 1,10 | xsect >streamed.tab
tabcmp --rel 1e-14 direct.tab streamed.tab >diff.txt 2>&1
ok $? 'and by size parameter'
is 1 "$(tabtxt --columns q_ext,q_sca streamed.tab | awk 'NR > 1 { print $1 == $2 }' | uniq)" 'no absorption: c_sca is c_ext to the last bit'

# The mean is the mean: from the rows of the single sizes.
mie-phase --particle 1.33 --wavelength 550nm --theta 0,60,180 two.tab | tabtxt --columns radius,theta,p >single
xsect --method mie --particle 1.33 --wavelength 550nm two.tab | tabtxt --columns radius,c_sca,weight >c
mie-phase --particle 1.33 --wavelength 550nm --theta 0,60,180 --average two.tab | tabtxt --columns theta,p >mean
ok "$(awk 'FILENAME == "c" { w[$1] = $2 * $3; if (FNR > 1) sum += w[$1]; next }
	FILENAME == "single" { if (FNR > 1) p[$2] += w[$1] * $3 / sum; next }
	FNR > 1 && ($2 / p[$1] - 1) ^ 2 > 1e-20 { bad = 1 }
	END { print bad + 0 }' c single mean)" '--average weights by weight x c_sca'

# Bytes do not depend on threads.
# shellcheck disable=SC2086
for tool in xsect mie-coeffs 'mie-phase --average' mie-phase; do
	for n in 1 3; do $tool $water --threads $n psd.tab >$n.tab; done
	cmp 1.tab 3.tab
	ok $? "$tool: the same bytes with 1 and 3 threads"
done
is 1 "$(tabtxt --columns radius,theta 1.tab | awk 'NR > 1 { n[$1]++ } END { for (r in n) print n[r] % 3 == 0 }' | uniq)" \
	'the wavelengths of a size share its grid'
mie-phase --particle 1.33 --size-parameter 2000 --threads 1 | cksum >one
mie-phase --particle 1.33 --size-parameter 2000 --threads 3 | cksum >three
is "$(cat one)" "$(cat three)" 'mie-phase: and for one large sphere'

# An angle does not depend on the others; the order given does not matter.
is "$(mie-phase --particle 1.33 --size-parameter 30 --theta 7 | tabtxt | tail -1)" \
	"$(mie-phase --particle 1.33 --size-parameter 30 --theta 90,7,3 | tabtxt | sed -n 3p)" 'an angle alone and among others'

# Geometrical optics where it fails says so, and only there.
xsect --method goa --particle 1.49 --wavelength 600nm --radius 0.1um,10um >goa.tab 2>err
is "0 1" "$? $(grep -c '^xsect: goa: radius 0.1 um, wavelength 0.6 um: ' err)" 'goa: one warning, naming the worst row'
is "-2.775 3" "$(tabtxt --columns c_ext,method goa.tab | awk 'NR == 2 { printf "%.3f %d", $1 / (3.14159265358979 * 0.01), $2 }')" \
	'goa: the extinction of a small sphere as the published formula has it'
xsect --method goa --particle 1.49 --wavelength 600nm --radius 10um >goa.tab 2>err
is "0 0" "$? $(wc -l <err)" 'goa: no warning for a large sphere'

# The cheapest method within the tolerance, and what says so.
xsect --particle 1.5+0.1i --tolerance 1e-3 --size-parameter 0.01:3e4:1000 --verbose 2>err >auto.tab
sed -n 's/^xsect: verbose: method \([a-z]*\) for [0-9]* sizes; estimated error at most .*/\1/p' err | sort >out
is 'cam mie rayleigh' "$(tr '\n' ' ' <out | sed 's/ $//')" \
	'--verbose says each method and its worst estimate'
is '1 2 4' "$(tabtxt --columns method auto.tab | sed 1d | sort -u | tr '\n' ' ' | sed 's/ $//')" 'auto: Rayleigh, Lorenz-Mie, asymptotics'
ok "$(tabtxt --columns error auto.tab | awk 'NR > 1 && $1 >= 1e-3 { bad = 1 } END { print bad + 0 }')" 'auto: every estimate is below the tolerance'
xsect --method mie --particle 1.5+0.1i --size-parameter 0.01:3e4:1000 >mie.tab
tabtxt --columns q_ext,q_sca,g auto.tab >a
tabtxt --columns q_ext,q_sca,g mie.tab | paste a - | awk '
	NR > 1 { for (i = 1; i <= 3; i++) { e = $i - $(i + 3); if (i < 3) e /= $(i + 3); if (e * e > 1e-6) bad = 1 } }
	END { exit bad + 0 }'
ok $? 'auto: and the truth is, too'
xsect --particle 1.5+0.1i --tolerance 1e-3 --size-parameter 0.01:3e4:1000 --threads 3 | cksum >three
xsect --particle 1.5+0.1i --tolerance 1e-3 --size-parameter 0.01:3e4:1000 --threads 1 | cksum >one
is "$(cat one)" "$(cat three)" 'auto: the same bytes with 1 and 3 threads'
xsect --particle 1.33 --size-parameter 1,100 >auto.tab
xsect --particle 1.33 --tolerance 1e-6 --method auto --size-parameter 1,100 | tabtxt >a
tabtxt auto.tab | cmp -s - a
ok $? 'auto within 1e-6 unless told otherwise'
for method in rayleigh cam evans-fournier; do
	x=100
	[ $method = rayleigh ] || x=1
	xsect --method $method --particle 1.33 --size-parameter 0.5,$x,200 2>err >out.tab
	is "0 1" "$? $(grep -c "^xsect: $method: x = [0-9.]*: this method does not hold there" err)" "$method: one warning beyond its domain"
done

# What is refused.
table() { printf '%b' "$1" | txttab >bad.tab; }
for tool in xsect mie-phase mie-coeffs; do
	refused "$tool: no particle" '--particle: is missing' $tool --wavelength 550nm --radius 1um
	refused "$tool: no wavelength" '--wavelength: is missing' $tool --particle 1.33 --radius 1um
	refused "$tool: x and radius" '--size-parameter: excludes' $tool --particle 1.33 --size-parameter 1 --radius 1um
done
refused 'a table and --radius' 'two.tab: a table of sizes excludes --radius' xsect --particle 1.33 --wavelength 550nm --radius 1um two.tab
refused 'two tables' 'one table at most' xsect --particle 1.33 --wavelength 550nm two.tab two.tab
refused 'a wavelength twice' '--wavelength: 0.55 um stands twice' xsect --particle 1.33 --wavelength 550nm,450nm,0.55um --radius 1um
xsect --particle 1.33 --wavelength 650nm,450nm,550nm two.tab | tabtxt --columns wavelength,radius >out
is '0.65 0.3,0.45 0.3,0.55 0.3,0.65 1,0.45 1,0.55 1' "$(sed 1d out | tr '\t\n' ' ,' | sed 's/,$//')" 'wavelengths come in the order given'
refused 'a radius beyond numbers' "'1e400um' is too large" xsect --particle 1.33 --wavelength 550nm --radius 1e400um
refused 'a radius that is none' "'nanum' is not a length" xsect --particle 1.33 --wavelength 550nm --radius nanum
refused 'x and wavelength' 'excludes --wavelength' xsect --particle 1.33 --wavelength 550nm --size-parameter 1
refused 'the other sign convention' '--particle: .*positive one absorbs' xsect --particle 1.5-0.1i --size-parameter 1
refused 'particle like host' 'does not scatter' xsect --particle 1.33 --host 1.33 --size-parameter 1
refused 'an index out of all bounds' '--particle: .*from 0.001 to 2000' xsect --particle 1e9 --size-parameter 1
refused 'an index too large for the size' '--particle: .*exceeds 1e\+09' xsect --particle 900 --size-parameter 1e7
refused 'x too large' 'from 1e-08 to 1e\+07' xsect --particle 1.33 --size-parameter 2e7
refused 'x of a radius too large' '--radius: .*radius 1e\+07 um.*from 1e-08 to 1e\+07' xsect --particle 1.33 --wavelength 100nm --radius 10m
table '# radius:f64:um\n1\n-2\n'
refused 'a negative radius' 'bad.tab: row 2: radius -2 um' xsect --particle 1.33 --wavelength 550nm bad.tab
table '# radius:f64:um\n1\nnan\n'
refused 'a radius that is no number' 'bad.tab: row 2: radius -?nan' mie-phase --particle 1.33 --wavelength 550nm bad.tab
table '# radius:f64:um\n'
refused 'no rows' 'bad.tab: has no rows' mie-phase --particle 1.33 --wavelength 550nm bad.tab
table '# radius:f64:m\n1\n'
refused 'radius in m' "column radius is in 'm'; 'um' is needed" mie-coeffs --particle 1.33 --wavelength 550nm bad.tab
table '# size:f64:um\n1\n'
refused 'no radius' 'has no column radius' mie-coeffs --particle 1.33 --wavelength 550nm bad.tab
refused '--average without weights' '--average: needs a table' mie-phase --particle 1.33 --wavelength 550nm --radius 1um --average
refused '--theta and --angles' '--angles: excludes' mie-phase --particle 1.33 --size-parameter 1 --angles 3 --theta 1
refused 'an angle twice' 'stands twice' mie-phase --particle 1.33 --size-parameter 1 --theta 1,1
mie-coeffs --particle 1.33 --wavelength 550nm --radius 1um >c.tab
refused 'coefficients and --particle' '--particle: is settled' xsect --particle 1.33 c.tab
refused 'coefficients and --host' '--host: is settled' mie-phase --host 1.33 c.tab
refused 'a tolerance of one method' '--tolerance: is for --method auto' xsect --method mie --tolerance 1e-3 --particle 1.33 --size-parameter 1
refused 'coefficients and goa' '--method: goa has no use' xsect --method goa c.tab
tabtxt c.tab | sed 5d | txttab >bad.tab
refused 'a coefficient is missing' 'row 4: n does not ascend' xsect bad.tab
tabtxt c.tab | sed 2d | txttab >bad.tab
refused 'the first coefficient is missing' 'row 1: a size does not begin with n = 1' xsect bad.tab
tabtxt c.tab | awk 'BEGIN { OFS = FS = "\t" } NR == 4 { $2 = 2 } 1' | txttab >bad.tab
refused 'the size changes midway' 'row 3: the size or wavelength changes' mie-phase bad.tab
done_testing
