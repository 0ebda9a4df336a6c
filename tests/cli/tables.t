#!/bin/sh
# Tables from elsewhere: CSV and NumPy become tables. Tables end to end.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"

psd lognormal --median 5um --gsd 1.5 --classes 6 -o sizes.tab
xsect --particle water --wavelength 550nm sizes.tab -o xsect.tab
particles --psd sizes.tab --count 50 --box 1m,1m,1m -o grains.tab

# What tabtxt writes comes back, with the units of the tools.
for table in sizes xsect grains; do
	tabtxt --csv $table.tab | txttab -o csv.tab && tabtxt $table.tab >want.txt && tabtxt csv.tab | sed '1s/:[if][0-9]*:/:TYPE:/g' >got.txt
	sed -i '1s/:[if][0-9]*:/:TYPE:/g' want.txt
	cmp want.txt got.txt >cmp.txt 2>&1
	ok $? "the CSV of $table comes back"
	tabtxt --npy $table.tab | txttab | tabtxt >npy.txt && tabtxt $table.tab | cmp - npy.txt
	ok $? "the NumPy of $table comes back, types and all"
done
tabtxt --csv sizes.tab >named.npy
txttab named.npy | tabtxt --columns radius >out && tabtxt --columns radius sizes.tab | cmp - out
ok $? 'a file is known by its content, not its name'
grep -o '{ "[a-z0-9_]*", TAB_...[^}]*}' "$top/lib/format/columns.h" | sed 's/"//g; s/[{}]//g; s/ //g' | sort -u >columns
is 0 $(($(wc -l <columns) < 30)) 'all columns are listed'
wrong=
while IFS=, read -r name type unit; do
	[ "$name" != x ] || continue
	got=$(printf '%s\n1\n' "$name" | txttab | tabtxt | sed -n "1s/^# $name:f64://p")
	[ "$got" = "$unit" ] || wrong="$wrong $name($type):'$got'"
done <columns
is '' "$wrong" 'each column has its unit where CSV has none'

# From anywhere.
header() { tabtxt | head -1; }
printf 'id,x,y,z,radius\n7,1,2,3,0.5\n8,-1,-2,1e-3,12\n' >any.csv
is '# id:f64:1	x:f64:m	y:f64:m	z:f64:m	radius:f64:um 7	1	2	3	0.5 8	-1	-2	0.001	12' \
	"$(txttab any.csv | tabtxt | tr '\n' ' ' | sed 's/ $//')" 'a table of particles; what no tool knows is carried'
is '# x:f64:1	radius:f64:um' "$(printf 'x,radius\n1,2\n' | txttab | header)" 'x without y and z is a size parameter'
is '# id:f64:1	x:f64:m	y:f64:m	z:f64:mm	radius:f64:um' "$(txttab --units z=mm,radius=um any.csv | header)" 'units given'
is "cmd	txttab --units z=mm,radius=um" "$(txttab --units z=mm,radius=um any.csv | grep -a '^cmd')" 'stand in the history'
printf '\357\273\277"id" , x,"y",z ,radius\r\n7, 1,"2",3 ," 0.5"\r\n8,-1,-2,1e-3,12\r\n' | sed 's/" 0.5"/"0.5"/' >excel.csv
txttab excel.csv | tabtxt >out && txttab any.csv | tabtxt | cmp - out
ok $? 'a byte order mark, CR LF, quotes and blanks make no difference'
mie-phase --particle water --wavelength 550nm --average sizes.tab -o phase.tab
bake() { medium-bake --xsect xsect.tab --phase phase.tab -o "$@"; }
tabtxt --csv --columns class,radius,z,y,x grains.tab | txttab | bake csv.medium && bake tab.medium grains.tab
for m in csv tab; do tail -c 1500 $m.medium | head -c -16 >$m.matter; done    # behind the history, before the checksum
cmp csv.matter tab.matter >cmp.txt 2>&1
ok $? 'particles of CSV make the same medium'

# What is wrong, and where.
bad() { refused "$1" "^txttab: $2" txttab -o bad.tab bad.csv; }
printf 'x,y\n1,2\n3,four\n' >bad.csv
bad 'a word' "bad.csv: line 3: column y: 'four' is not a number"
printf 'x,y\n1,\n' >bad.csv
bad 'an empty field' 'bad.csv: line 2: column y: is empty'
printf 'x,y\n1\n' >bad.csv
bad 'too few' 'bad.csv: line 2: fewer than 2 columns: no y'
printf 'x,y\n1,2,3\n' >bad.csv
bad 'too many' 'bad.csv: line 2: more than 2 columns'
printf 'x,y\n1,2\n3,4' >bad.csv
bad 'cut short' 'bad.csv: line 3: is cut short'
printf 'x,y\n1,2\n\n' >bad.csv
bad 'an empty line' 'bad.csv: line 3: column x: is empty'
printf '1,2\n3,4\n' >bad.csv
bad 'no names' "bad.csv: line 1: must name the columns; '1' is a number"
printf 'x;y\n3;4\n' >bad.csv
bad 'another separator' "bad.csv: line 1: must name the columns.* column 1, 'x;y'"
printf 'x,x\n3,4\n' >bad.csv
bad 'a name twice' 'bad.csv: line 1: column x stands twice'
printf 'x,"y\n3,4\n' >bad.csv
bad 'an open quote' 'bad.csv: line 1: column 2: its quote does not end'
printf 'x,y\n"3"1,4\n' >bad.csv
bad 'text after a quote' 'bad.csv: line 2: column 1: has text after its quote'
printf 'x,y\n1e999,4\n' >bad.csv
bad 'too large' "bad.csv: line 2: column x: '1e999' is too large"
: >bad.csv
bad 'nothing' 'bad.csv: is empty'
refused 'a unit of no column' 'any.csv: has no column q \(--units\)' txttab --units q=m any.csv
refused 'no unit' "'radius' is not NAME=UNIT" txttab --units radius any.csv
refused 'a unit with a colon' 'column x: a unit is printable' txttab --units x=m:m any.csv
tabtxt sizes.tab >sizes.txt
refused 'units beside units' 'has units of its own' txttab --units radius=um sizes.txt
tabtxt --npy sizes.tab >whole.npy
for cut in 5 40 200 $(($(wc -c <whole.npy) - 1)); do
	head -c "$cut" whole.npy >bad.csv
	bad "NumPy cut at $cut" 'bad.csv: the array is cut short'
done
{ cat whole.npy; echo; } >bad.csv
bad 'bytes after NumPy' 'bad.csv: has bytes after the array'
# npy DESCR SHAPE: a header of version 1.
npy() {
	dict="{'descr': $1, 'fortran_order': False, 'shape': $2, }"
	printf "\223NUMPY\001\000\\$(printf '%03o' $((${#dict} + 1)))\\000%s\n" "$dict"
}
{ npy "[('id', '<i8'), ('i', '|i1'), ('u', '<u2'), ('r', '<f4')]" '(2,)'
	printf '\376\377\377\377\377\377\377\377\200\377\377\000\000\200\077'
	printf '\000\000\000\000\000\000\040\000\177\001\000\000\000\000\100'; } >ints.npy
is '# id:f64:1	i:i32:1	u:i32:1	r:f32:1 -2	-128	65535	1 9007199254740992	127	1	2' \
	"$(txttab ints.npy | tabtxt | tr '\n' ' ' | sed 's/ $//')" 'integers of NumPy'
{ npy "[('id', '<u8')]" '(1,)'; printf '\001\000\000\000\000\000\040\000'; } >bad.csv
bad 'an integer without a double' 'bad.csv: row 1: column id: an integer beyond 2\^53'
npy "'<f8'" '(2, 2)' >bad.csv
bad 'an array without fields' 'bad.csv: its rows have no named fields'
npy "[('id', '<f8')]" '(2, 2)' >bad.csv
bad 'too many dimensions' 'bad.csv: has 2 dimensions'
npy "[('id', '>f8')]" '(2,)' >bad.csv
bad 'big-endian' 'bad.csv: field id: is not one little-endian number'
npy "[('p', '<f8', (3,))]" '(2,)' >bad.csv
bad 'a field of three' 'bad.csv: field p: is not one'
npy "[('p', '<f8'), ('p', '<f8')]" '(2,)' >bad.csv
bad 'a field twice' 'bad.csv: field p stands twice'
is '' "$(ls bad.tab* 2>/dev/null)" 'none of these left a file'

# tabcat.
xsect --particle 1.33 --wavelength 650nm sizes.tab -o red.tab
xsect --particle 1.34 --wavelength 450nm sizes.tab -o blue.tab
tabcat red.tab blue.tab -o both.tab && tabtxt both.tab >out && { tabtxt red.tab; tabtxt blue.tab | sed 1d; } | cmp - out
ok $? 'the rows of one table, then of the other'
is "$(sed -n '/^cmd/p' sizes.tab; sed -n '/^cmd.xsect/p' red.tab blue.tab; echo 'cmd	tabcat')" "$(sed -n '/^cmd/p' both.tab)" \
	'histories are joined, the common part once'
tabtxt red.tab >red.txt
tabcat red.tab - <blue.tab | cmp - both.tab && tabcat <red.tab | tabtxt | cmp - red.txt
ok $? 'one of them may be standard input, or all there is'
tabtxt --columns c_sca,c_ext,radius,wavelength blue.tab | txttab >turned.tab
tabtxt --columns wavelength,radius,c_ext,c_sca red.tab | txttab | tabcat - turned.tab | tabtxt >out
tabtxt --columns wavelength,radius,c_ext,c_sca both.tab | cmp - out
ok $? 'columns are found by name'
printf '# a:f32:1\n0.1\n' | txttab >single.tab
printf '# a:f64:1\n0.1\n' | txttab >double.tab
is '# a:f64:1 0.10000000149011612 0.1' "$(tabcat single.tab double.tab | tabtxt | tr '\n' ' ' | sed 's/ $//')" 'no value is rounded'
is '# a:f32:1 0.1 0.1' "$(tabcat single.tab single.tab | tabtxt | tr '\n' ' ' | sed 's/ $//')" 'of one type it stays'
printf '# a:f64:m\n0.1\n' | txttab >metre.tab
printf '# a:f64:1\tb:f64:1\n0.1\t2\n' | txttab >more.tab
refused 'another unit' "^tabcat: metre.tab: column a is in 'm'; '1' is needed" tabcat -o no.tab double.tab metre.tab
refused 'a column more' '^tabcat: more.tab: has a column b, which double.tab has not' tabcat -o no.tab double.tab more.tab
refused 'a column less' '^tabcat: double.tab: has no column b' tabcat -o no.tab more.tab double.tab
refused 'standard input twice' 'only one' tabcat - - <red.tab
head -c 300 blue.tab >cut.tab
refused 'a table cut short' 'cut.tab: the table is cut short' tabcat -o no.tab red.tab cut.tab
is '' "$(ls no.tab* 2>/dev/null)" 'and none of these left a file'
done_testing
