#!/bin/sh
# The manual: every page is clean, every tool has one that knows its options, and every example runs.
#
# An example is a line that begins with "$ " in a literal display under EXAMPLES; a backslash, a pipe or && at its end continue it.
# The examples of a display run one after the other by sh in an empty folder, must exit 0 and write nothing to stderr. Lines
# beneath them are what they print, compared but for the amount of white space; a display without such lines may print anything.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"

# A page as plain text.
plain() { mandoc -T ascii -O width=200 "$1" | sed "s/.$(printf '\b')//g"; }

# examples PREFIX: split the page on standard input into PREFIX.1.sh, PREFIX.1.want, ...
examples() {
	awk -v prefix="$1" '
		# A backslash, a pipe or && at its end continue a command.
		function put() { glue = sub(/\\$/, "") ? " " : "\n"; more = glue == " " || /(\||&&) *$/; printf "%s%s", $0, glue >script }
		/^[A-Z]/ { inside = $0 == "EXAMPLES"; shown = 0; next }
		!inside { next }
		{ match($0, /^ */); indent = RLENGTH }
		more { sub(/^ */, ""); put(); next }
		/^ *\$ / && (!shown || indent == margin) {
			if (!shown) { shown = 1; margin = indent; i++; script = prefix "." i ".sh"; want = prefix "." i ".want"; printf "" >want }
			sub(/^ *\$ /, ""); put(); next
		}
		!shown { next }
		$0 != "" && indent < margin { shown = 0; next }
		{ print >want }'
}

# White space as it may.
loosely() { sed 's/[[:space:]][[:space:]]*/ /g; s/^ //; s/ $//' "$1" | sed -e :a -e '/^\n*$/{$d;N;ba' -e '}'; }

for page in "$top"/man/*.[1-9]; do
	name=$(basename "$page")
	mandoc -T lint -W warning "$page" >"$tmp/lint" 2>&1
	ok $? "$name is clean"
	sed 's/^/# /' "$tmp/lint"
	plain "$page" >"$tmp/plain"
	needed='NAME DESCRIPTION SEE.ALSO'
	case $name in *.1) needed='NAME SYNOPSIS DESCRIPTION EXIT.STATUS EXAMPLES SEE.ALSO' ;; esac
	missing=
	for s in $needed; do grep -q "^$s\$" "$tmp/plain" || missing="$missing $s"; done
	is '' "$missing" "$name has the sections it needs"
	examples "$tmp/$name" <"$tmp/plain"
	case $name in *.1) ok "$([ -f "$tmp/$name.1.sh" ]; echo $?)" "$name has an example" ;; esac
	for script in "$tmp/$name".*.sh; do
		[ -f "$script" ] || continue
		label=$(basename "$script" .sh)
		rm -rf "$tmp/folder"
		mkdir "$tmp/folder"
		(cd "$tmp/folder" && exec sh -e "$script") >"$tmp/out" 2>"$tmp/err" </dev/null
		status=$?
		loosely "$tmp/$label.want" >"$tmp/want"
		if [ -s "$tmp/want" ]; then loosely "$tmp/out" >"$tmp/got"; else : >"$tmp/got"; fi
		if [ $status -eq 0 ] && ! [ -s "$tmp/err" ] && cmp -s "$tmp/want" "$tmp/got"; then
			ok 0 "example $label: $(head -1 "$script" | tr '#' ' ')"
		else
			ok 1 "example $label, exit $status"
			cat "$script" "$tmp/err" | sed 's/^/# /'
			diff -u "$tmp/want" "$tmp/got" | sed 's/^/# /'
		fi
	done
done

for source in "$top"/tools/*.c; do
	t=$(basename "$source" .c)
	page=$top/man/$t.1
	ok "$([ -f "$page" ]; echo $?)" "$t has a page"
	[ -f "$page" ] || continue
	# Every option of --help is in the page, and every one that the page explains (.It Fl) is in --help.
	"$t" --help | sed -n 's/^  \(-[-a-z0-9]*\).*/\1/p' | sort -u >"$tmp/has"
	sed -n 's/^\.It Fl /Fl /p' "$page" | grep -o 'Fl [-a-z0-9]*' | sed 's/^Fl /-/' | sort -u >"$tmp/says"
	plain "$page" | grep -oE -e '--?[a-z][-a-z0-9]*' | sort -u >"$tmp/shows"
	is '' "$(grep -vxE -e '--(help|version)' "$tmp/has" | comm -23 - "$tmp/shows")" "$t.1 has all options"
	is '' "$(comm -13 "$tmp/has" "$tmp/says")" "and no others"
done

# The README's pipelines, one after the other; its make commands are run by whoever reads it.
awk '/^```sh/ { block = ""; inside = 1; next }
     /^```/ { if (inside && block !~ /^make/) printf "%s", block; inside = 0 }
     inside { block = block $0 "\n" }' "$top/README.md" >"$tmp/readme.sh"
mkdir "$tmp/readme"
(cd "$tmp/readme" && exec sh -e ../readme.sh) >"$tmp/out" 2>"$tmp/err" </dev/null
is "0 fog.png" "$? $(cd "$tmp/readme" && echo ./*.png | cut -c3-)$(cat "$tmp/err")" 'the pipelines of the README run'
done_testing
