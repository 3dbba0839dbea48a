# code.awk - prints the ```c blocks of the Markdown files named, in that order: the program text of
# spec 4.5.
# SPDX-License-Identifier: BSD-2-Clause
FNR == 1        { inside = 0 }
/^```c$/        { inside = 1; printf "#line %d \"%s\"\n", FNR + 1, FILENAME; next }
/^```/          { inside = 0 }
inside          { print }
