#!/bin/sh
# What every tool keeps: options, text and back, comparisons, pictures.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
tools=$(cd "$top/tools" && echo *.c | sed 's/\.c//g')
tab=$(printf '\t')

for t in $tools; do
	"$t" --help >out 2>err
	is "0 0 usage: $t " "$? $(wc -c <err) $(head -1 out | cut -c "1-$((8 + ${#t}))")" "$t --help"
	"$t" --version >out 2>err
	is "0 0 $t (motes)" "$? $(wc -c <err) $(cut -d' ' -f1,2 out)" "$t --version"
	refused "$t --no-such-option" "^$t: --no-such-option: unknown option" "$t" --no-such-option
done

# Options.
printf '# radius:f64:um\tweight:f64:1\n1\t0.5\n3\t0.5\n' >t.txt
txttab t.txt -o t.tab
refused 'a flag takes no value' 'takes no value' tabtxt --csv=yes t.tab
refused 'an option that needs a value' 'needs a value' tabtxt --columns
refused 'an empty value' 'is empty' tabtxt --columns= t.tab
refused 'an option in a wrong spelling' 'unknown option' tabtxt -columns radius t.tab
refused 'none of the choices' 'none of the choices 16\|8' exr2png --bits 12
refused 'a choice of two at once' 'none of the choices' exr2png --bits '16|8'
refused 'a number out of range' 'out of range: from -60 to 60' exr2png --exposure 61
refused 'not a number' 'is not a number' tabcmp --rel x t.tab t.tab
refused 'a number not decimal' 'is not a decimal number' tabcmp --rel 0x1 t.tab t.tab

# Units as people write them.
for radius in '0.55µm' '0.55μm'; do
	xsect --particle 1.5+0.1j --wavelength 94GHz --radius "$radius" -o unit.tab 2>err &&
		xsect --particle 1.5+0.1i --wavelength 3189.2814680851063829787um --radius 550nm | tabcmp - unit.tab >out 2>>err
	is '0 ' "$? $(cat err)" "$radius, 94GHz and 1.5+0.1j"
done
xsect --particle 1.33 --wavelength 90GHz:94GHz:2GHz --radius 1mm | tabtxt --columns wavelength >out
is '# wavelength:f64:um 3331.027311111111 3258.6136739130434 3189.2814680851066' "$(tr '\n' ' ' <out | sed 's/ $//')" 'a range of frequencies'
refused 'a radius in GHz' 'unknown unit' xsect --particle 1.33 --wavelength 1um --radius 94GHz
refused 'a frequency in a wrong spelling' 'unknown unit \(nm, um, .*kHz' xsect --particle 1.33 --wavelength 94ghz --radius 1um
refused 'no frequency' 'is not a frequency' xsect --particle 1.33 --wavelength 0GHz --radius 1um

refused 'too many operands' 'one table at most' tabtxt t.tab t.tab
refused 'a file that is not there' '^tabtxt: nowhere: cannot open: No such file' tabtxt nowhere
refused 'a folder' '^tabtxt: \.: cannot read: Is a directory' tabtxt .
refused 'a folder that is not there' 'cannot create: No such file' txttab -o no/where t.txt
tabtxt --columns=weight t.tab >out
is "# weight:f64:1 0.5 0.5" "$(tr '\n' ' ' <out | sed 's/ $//')" 'a value after an equals sign; a choice of columns'
tabtxt -- t.tab | cmp - t.txt
ok $? 'operands after --'
tabtxt <t.tab | cmp - t.txt && tabtxt - <t.tab | cmp - t.txt
ok $? 'no operand and - are standard input'
is "radius,weight 1,0.5 3,0.5" "$(tabtxt --csv t.tab | tr '\n' ' ' | sed 's/ $//')" 'CSV'
is "cmd${tab}txttab" "$(grep -a '^cmd' t.tab)" 'the history has the command without its files'

# Text and back: the same bits.
cat >edge.txt <<EOT
# i:i32:1${tab}f:f32:um${tab}d:f64:um^2
-2147483648${tab}1e-45${tab}5e-324
2147483647${tab}3.4028235e+38${tab}1.7976931348623157e+308
0${tab}1.1754944e-38${tab}2.2250738585072014e-308
1${tab}-0${tab}-0
2${tab}0.1${tab}0.1
3${tab}inf${tab}-inf
4${tab}nan${tab}nan
5${tab}16777216${tab}9007199254740993
6${tab}1.1754942e-38${tab}2.225073858507201e-308
EOT
txttab edge.txt | tabtxt >back.txt
sed 's/9007199254740993/9007199254740992/' edge.txt | diff - back.txt >difference
ok $? 'extremes and subnormals print as the shortest decimals'
txttab edge.txt | tabtxt | txttab | tabtxt | cmp - back.txt
ok $? 'and text to table to text is the identity'
awk 'BEGIN { srand(7); print "# f:f32:1\td:f64:1"
	for (i = 0; i < 20000; i++) printf "%.9fe%d\t%.17fe%d\n", rand(), int(rand() * 76) - 38, rand(), int(rand() * 600) - 300 }' |
	txttab -o random.tab
tabtxt random.tab | txttab | cmp - random.tab
ok $? 'table to text to table likewise, for 20000 rows'
txttab edge.txt | tabtxt --npy -o edge.npy
is "NUMPY 0" "$(head -c 6 edge.npy | tail -c 5) $((($(wc -c <edge.npy) - 9 * 16) % 64))" 'NumPy: magic, and aligned rows of 16 bytes'
refused 'text without its first line' 'line 1: must name the columns' txttab <<EOT
1 2
EOT
refused 'a missing value' 'line 2: fewer than 2 columns' txttab -o bad.tab <<EOT
# a:f64:1${tab}b:f64:1
1
EOT
for bad in 'a:f64' 'a:f16:1' ':f64:1' 'a b:f64:1' 'a:f64:' 'a:f64:1	a:f64:1'; do
	echo "# $bad" >bad.txt
	refused "the column line '$bad'" '^txttab: ' txttab -o bad.tab bad.txt
done
printf '# a:f32:1\n1e39\n' >bad.txt
refused 'too large for f32' 'does not fit an f32' txttab -o bad.tab bad.txt
printf '# a:i32:1\n1.5\n' >bad.txt
refused 'too broken for i32' 'does not fit an i32' txttab -o bad.tab bad.txt
is '' "$(ls bad.tab* 2>/dev/null)" 'and none of these left a file'

# tabcmp.
printf '# weight:f32:1\tradius:f64:um\n0.5\t1\n0.5\t3.003\n' | txttab -o u.tab
tabcmp t.tab t.tab >out
is 0 $? 'a table equals itself'
tabcmp t.tab u.tab >out
is 1 $? 'another differs, whatever the order and type of its columns'
golden tabcmp.txt out
tabcmp --rel 1.1e-3 t.tab u.tab >out && tabcmp --abs 3.1e-3 t.tab u.tab >out && ! tabcmp --rel 9e-4 t.tab u.tab >out
ok $? 'within a tolerance it agrees'
tabcmp --abs 2e-3 --rel 0.5e-3 t.tab u.tab >out
is 0 $? 'the two tolerances add up'
printf '# radius:f64:m\tother:f64:1\n1\t2\n' | txttab | tabcmp t.tab - --abs 1e9 >out
is 1 $? 'other columns, units and lengths differ at any tolerance'
golden tabcmp-shape.txt out

# Images, against OpenImageIO.
oiiotool --pattern noise:seed=3 61x43 3 -d float -o a.exr && oiiotool a.exr --addc 0.25,0,0 -d float -o b.exr
exr2png a.exr -o a.png && oiiotool a.exr --colorconvert linear sRGB -d uint16 -o want.tif
idiff -q -fail 2e-5 a.png want.tif >/dev/null
ok $? 'exr2png encodes as OpenImageIO does, to 16 bits'
exr2png --bits 8 --exposure -1 <a.exr >a8.png && oiiotool a.exr --mulc 0.5 --colorconvert linear sRGB -d uint8 -o want.tif
idiff -q -fail 4e-3 a8.png want.tif >/dev/null
ok $? 'and to 8, a stop darker'
is 1 "$(oiiotool --stats a8.png | grep -c '61 x *43, 3 channel, uint8 png')" 'the PNG is what it says'
exr2png a.exr | cmp - a.png
ok $? 'the same bytes go down a pipe'
kinds='' write='' rewrite='' wrong=''
for c in none rle zips zip piz pxr24; do
	for d in half float; do
		for shape in 'scanline' 'tile 32 16'; do
			kind=$c-$d-${shape% * *}
			kinds="$kinds $kind"
			write="$write a.exr -d $d --compression $c --$shape -o $kind.exr"
			rewrite="$rewrite $kind.exr -d float --scanline --compression zip -o float-$kind.exr"
		done
	done
done
# shellcheck disable=SC2086
oiiotool $write && oiiotool $rewrite
for kind in $kinds; do imgcmp "$kind.exr" "float-$kind.exr" >out || wrong="$wrong $kind"; done
is '24 ' "$(echo "$kinds" | wc -w) $wrong" 'every compression, half and float, lines and tiles are read as OpenImageIO reads them'
imgcmp a.exr a.exr >out
is 0 $? 'an image equals itself'
imgcmp a.exr b.exr >out
is "1 0.25" "$? $(awk '$1 == "R" { print $2 }' out)" 'another differs, and by how much'
imgcmp --channels G,B a.exr b.exr >out && imgcmp --max 0.2501 a.exr b.exr >out && imgcmp --rms 0.2501 --block 4 a.exr b.exr >out
ok $? 'channels, tolerances, blocks'
oiiotool a.exr --crop 60x43 -d float -o c.exr
imgcmp --difference d.exr b.exr a.exr >out
oiiotool --stats d.exr >out
is "Stats Avg: 0.250000 0.000000 0.000000 (float)" "$(grep Avg out | sed 's/^ *//')" 'the picture of a difference'
refused 'images of different sizes' 'c.exr: is 60 x 43 pixels, a.exr is 61 x 43' imgcmp a.exr c.exr
oiiotool --pattern constant:color=1 8x8 1 --chnames Z -d float -o z.exr
refused 'a picture without colours' 'neither channels R, G, B nor a channel Y' exr2png z.exr
oiiotool z.exr --chnames Y -d float -o y.exr
exr2png y.exr -o y.png && oiiotool --stats y.png >out
is "Stats Min: 65535 65535 65535 (of 65535)" "$(grep Min out | sed 's/^ *//')" 'a single channel Y is grey'
oiiotool z.exr --chnames Y -d uint32 -o i.exr
refused 'a picture of integers' 'channel Y holds integers' exr2png i.exr
oiiotool --pattern constant:color=1,1,1 1x1 3 -d float --compression none -o one.exr
{ head -c -4 one.exr; printf '\000\000\300\177'; } >nan.exr
refused 'a pixel that is not a number' 'nan.exr: channel R is not a number at column 0, row 0' exr2png nan.exr
imgcmp one.exr nan.exr --max 1e9 >out
is 1 $? 'is beyond any tolerance from one that is'
imgcmp nan.exr nan.exr >out
is 0 $? 'but equals itself'
done_testing
