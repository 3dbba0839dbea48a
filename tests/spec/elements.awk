# elements.awk - turns the table of annex J.2 into C: ID(name, number), one line an element.
# SPDX-License-Identifier: BSD-2-Clause
BEGIN { FS = " *\\| *" }
/^\| id \| element \| kind/ { table = 1; next }
table && !/^\|/ { exit }
table && /^\| [0-9]/ { printf "ID(%s, %d)\n", $3, $2 }
