#!/usr/bin/env python3
"""circles.py FOLDER [FLOOR,FLOOR,...] - finds out which file calls which, from the definitions and
uses of functions in the C files below FOLDER. A file is a .c file together with the header of its
name. Prints the files that lie on a circle of calls of more than two files. Where floors are given,
lowest first and folders of one floor joined by +, also prints the calls that go up, or across to
another folder of the same floor. The name of FOLDER itself is then "."."""
import os
import re
import sys

MOST = 2  # files of a circle

# Comments, strings, characters and lines of the preprocessor but definitions of macros.
NOISE = re.compile(r'/\*.*?\*/|"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])*\'|^#(?! *define)[^\n]*',
                   re.S | re.M)
# A function at the first column, and whether its body follows (TED4_LEVELED: render/leveled.h).
FUNCTION = re.compile(r'^(?!static (?!inline))[a-z][\w \t*]*?\b(?:TED4_LEVELED\()?(\w+)\)?'
                      r'\((?:[^;{}()]|\((?:[^;{}()]|\([^;{}()]*\))*\))*\)(\n\{|;)', re.M)
# A function that is called or passed on; neither a member nor a type.
USE = re.compile(r'(?<![\w.>])([a-z]\w+)(?=\s*[(),;:?}&|=!])')
CAST = re.compile(r'(?<!\w)\(\w+\)(?= ?[\w(])')
# The parts of a header that are not declarations: bodies of functions, and macros.
BODY = re.compile(r'^\{\n.*?^\}|^# *define(?:[^\n]*\\\n)*[^\n]*', re.S | re.M)


def read(path):
    """The text of a file, and the part of it in which functions are used."""
    with open(path, encoding='utf-8') as file:
        text = NOISE.sub(' ', file.read())
    used = FUNCTION.sub(lambda m: ' ' if m.group(2) == ';' else m.group(), text)
    if path.endswith('.h'):
        used = '\n'.join(BODY.findall(text))
    return text, CAST.sub(' ', used)


def modules(folder):
    """By path without suffix: the functions that a .c file and its header offer, define, and
    use."""
    found = {}
    for at, _, names in sorted(os.walk(folder)):
        for name in sorted(names):
            stem, suffix = os.path.splitext(os.path.join(at, name))
            if suffix in ('.c', '.h'):
                text, used = read(stem + suffix)
                offered, own, uses = found.setdefault(stem, (set(), set(), set()))
                for f in FUNCTION.finditer(text):
                    if f.group(2) != ';':
                        own.add(f.group(1))
                        if suffix == '.h' or not f.group().startswith('static'):
                            offered.add(f.group(1))
                uses |= set(USE.findall(used))
    return found


def calls(found):
    """{module: {module that it calls: functions}}."""
    owner, graph = {}, {}
    for stem, (offered, _, _) in found.items():
        for name in offered:
            owner.setdefault(name, stem)
    for stem, (_, own, uses) in found.items():
        to = graph[stem] = {}
        for name in uses - own:
            if name in owner:
                to.setdefault(owner[name], set()).add(name)
    return graph


def circles(graph):
    """Strongly connected components of more than one module (Tarjan)."""
    number, low, stack, found = {}, {}, [], []

    def visit(v):
        number[v] = low[v] = len(number)
        stack.append(v)
        for w in graph[v]:
            if w not in number:
                visit(w)
                low[v] = min(low[v], low[w])
            elif w in stack:
                low[v] = min(low[v], number[w])
        if low[v] == number[v]:
            members = []
            while not members or members[-1] != v:
                members.append(stack.pop())
            if len(members) > 1:
                found.append(sorted(members))

    for v in graph:
        if v not in number:
            visit(v)
    return found


def climbs(folder, graph, floors):
    """Calls from a floor to a higher one, or to another folder of the same."""
    level = {name: i for i, names in enumerate(floors) for name in names.split('+')}

    def room(stem):
        name = os.path.relpath(stem, folder).split(os.sep)
        return name[0] if len(name) > 1 else '.'

    for stem in graph:
        if room(stem) not in level:
            yield f'{stem}: its folder has no floor'
            continue
        for to, names in sorted(graph[stem].items()):
            here, there = room(stem), room(to)
            if here != there and there in level and level[there] >= level[here]:
                yield f'{stem}.c: calls {", ".join(sorted(names))} of {to}.c, which is not below it'


def main(folder, floors):
    graph = calls(modules(folder))
    bad = list(climbs(folder, graph, floors)) if floors else []
    for members in circles(graph):
        if len(members) > MOST:
            files = ' '.join(os.path.relpath(m, folder) for m in members)
            bad.append(f'{folder}: a circle of {len(members)} files: {files}')
    print('\n'.join(bad), end='\n' if bad else '')
    return 1 if bad else 0


if __name__ == '__main__':
    sys.setrecursionlimit(10000)
    sys.exit(main(sys.argv[1], sys.argv[2].split(',') if len(sys.argv) > 2 else []))
