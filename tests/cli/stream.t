#!/bin/sh
# Pipes: failures travel down, early ends are silent, outputs appear when they are whole.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"

text='# radius:f64:um\tweight:f64:1\n1\t0.5\n3\t0.5\n'
# shellcheck disable=SC2059
printf "$text" | txttab -o t.tab
awk 'BEGIN { print "# radius:f64:um"; for (i = 1; i <= 400000; i++) print i }' | txttab -o big.tab

# A producer that dies: no end mark, so that the last of the pipe fails, though sh has no pipefail.
printf '# radius:f64:um\n1\nx\n' | txttab 2>err | tabtxt >out 2>err2
is 2 $? 'a dead producer makes the end of the pipe exit 2'
is 'txttab: standard input: line 3: column radius: '"'x' is not a number" "$(cat err)" 'the producer says why'
is 1 "$(wc -l <err2)" 'and the consumer that it is cut short'
refused 'an empty pipe is no table' 'is empty' tabtxt <<EOT
EOT
true | tabtxt >/dev/null 2>err
is 2 $? 'a producer that wrote nothing is a failure too'
head -c 2000000 big.tab | tabtxt >out 2>err
is "2 1" "$? $(wc -l <err)" 'a table too long to be read ahead fails as well when it is cut'
head -c 2000000 big.tab | tabtxt -o cut.txt 2>err
is "2 " "$? $(ls cut.txt* 2>/dev/null)" 'and then leaves no file'
{ cat t.tab; cat t.tab; } >two.tab
refused 'two tables one after the other are refused' 'after the end mark' tabtxt two.tab

# A consumer that has enough: SIGPIPE ends the producer without a word.
{ tabtxt big.tab 2>err; echo $? >status; } | head -c 10 >/dev/null
is "141 0" "$(cat status) $(wc -c <err)" 'head ends tabtxt silently'
{ tabtxt big.tab | txttab 2>err; echo $? >status; } | head -c 10 >/dev/null
is "141 0" "$(cat status) $(wc -c <err)" 'head ends txttab silently'
{ (trap '' PIPE; exec tabtxt big.tab) 2>err; echo $? >status; } | head -c 10 >/dev/null
is "141 0" "$(cat status) $(wc -c <err)" 'even where the signal was left ignored'

# A full disk.
oiiotool --pattern noise 64x64 3 -d float -o a.exr
for command in 'tabtxt t.tab' 'tabtxt --npy t.tab' 'tabtxt big.tab' 'tabcmp t.tab t.tab' 'imgcmp a.exr a.exr' 'exr2png a.exr' \
	'tabtxt --help' 'tabtxt --version'; do
	# shellcheck disable=SC2086
	$command >/dev/full 2>err
	is "2 1" "$? $(wc -l <err)" "$command says that the disk is full"
done
tabtxt t.tab | txttab >/dev/full 2>err
is "2 1" "$? $(wc -l <err)" 'so does txttab'
tabtxt t.tab -o /dev/full 2>err
is "2 1" "$? $(wc -l <err)" 'and -o to a device'

# A terminal. script gives its command one and passes the exit status on; --quiet output holds the message.
tabtxt t.tab >t.txt
if script -qec true /dev/null >/dev/null 2>&1 </dev/null; then
	script -qec 'txttab t.txt' /dev/null >out 2>&1 </dev/null
	is 2 $? 'txttab refuses to write a table to a terminal'
	is 'txttab: standard output: is a terminal; binary data goes to a file or a pipe' "$(tr -d '\r' <out)" 'and says what to do'
	script -qec 'tabtxt --npy t.tab' /dev/null >out 2>&1 </dev/null
	is 2 $? 'tabtxt refuses to write NumPy to a terminal'
	script -qec 'exr2png a.exr' /dev/null >out 2>&1 </dev/null
	is 2 $? 'exr2png refuses to write a picture to a terminal'
	script -qec 'tabtxt t.tab' /dev/null >out 2>&1 </dev/null
	is "0 $(cat t.txt)" "$? $(tr -d '\r' <out)" 'text goes there'
else
	for i in 1 2 3 4 5; do skip "terminal $i" 'no terminal to be had'; done
fi

# An interrupted run leaves nothing, not even where a file cannot be nameless until it is whole (as without /proc).
interrupted() {
	mkfifo pipe
	mkdir "$1"
	"$2" txttab -o "$1/out.tab" <pipe &
	victim=$!
	{ cat t.txt; sleep 0.3; kill -TERM $victim; wait $victim; } >pipe 2>/dev/null
	status=$?
	rm pipe
	is "143 " "$status $(ls -A "$1")" "$3"
}
# shellcheck disable=SC2317    # called by interrupted
plainly() { exec "$@"; }
# shellcheck disable=SC2016
hide='mount -t tmpfs none /proc/$$/fd && exec "$@"'
without_proc() { exec unshare -rm sh -c "$hide" sh "$@"; }
interrupted one plainly 'an interrupted run leaves no file'
if unshare -rm sh -c "$hide" sh true 2>/dev/null; then
	interrupted two without_proc 'nor where it had to have a name'
	(printf '# a:f64:1\nx\n' | without_proc txttab -o failed.tab) 2>err
	is "2 " "$? $(ls failed* 2>/dev/null)" 'a failed one neither'
	(without_proc txttab t.txt -o proc.tab) && cmp proc.tab t.tab
	is "0 proc.tab" "$? $(ls proc*)" 'and a good one writes its file'
else
	for i in 1 2 3; do skip "without /proc $i" 'no unshare'; done
fi
done_testing
