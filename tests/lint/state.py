#!/usr/bin/env python3
"""state.py FILE... - finds variables of C files, or headers, that outlive a call: objects of a
file, and static or thread-local ones of a function, that are not constant, including those in
macros and behind conditions of the preprocessor. Prints "FILE: keeps: DECLARATION" for each, and
then ends with status 1."""
import re
import sys

NOISE = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.S)
DIRECTIVE = re.compile(r'^[ \t]*#[^\n]*', re.M)
MACRO = re.compile(r'^[ \t]*# *define +\w+(?:\([^)]*\))?([^\n]*)', re.M)
LASTS = re.compile(r'\b(static|_Thread_local|__thread)\b')
# Specifiers of a declaration whose parentheses are not those of a function.
ASIDE = re.compile(r'\b(_Alignas|__attribute__) *\((?:[^()]|\((?:[^()]|\([^()]*\))*\))*\)')
ATOMIC = re.compile(r'\b_Atomic *\(([^()]*)\)')
BOUNDS = re.compile(r'\[[^\]]*\]')
TYPE = r'\b(struct|union|enum)( +\w+)? *'
NOT_AN_OBJECT = re.compile(r'(typedef|extern|_Static_assert)\b|' + TYPE + r'({})?$')
SPECIFIER = re.compile(r'\b(static|inline|const|volatile|_Thread_local|__thread)\b')
WORD = re.compile(r'\w+|{}')
POINTER_TO_FUNCTION = re.compile(r'\( *\*([^()]*)\)')


def statements(text):
    """For each declaration or statement that ends in a semicolon: whether it is in a function, and
    its text up to its value. Bodies of types and values in braces are left out."""
    stack, head, value = [], '', None  # value: its open parentheses
    for c in text:
        if c == '{':
            if value is not None or (stack and stack[-1] == 'left out'):
                stack.append('left out')
            elif re.search(TYPE + '$', head):
                stack.append('left out')
                head += ' {}'
            elif re.search(r'\bextern *$', head):
                stack.append('file')
                head = ''
            else:
                stack.append('function')
                head = ''
        elif c == '}':
            if stack and stack.pop() != 'left out':
                head, value = '', None
        elif stack and stack[-1] == 'left out':
            pass
        elif c == ';':
            yield 'function' in stack, ' '.join(head.split())
            head, value = '', None
        elif c == '=' and head.count('(') == head.count(')'):
            value = 0
        elif value is None or (value == 0 and c == ','):
            head, value = head + c, None
        else:
            value += (c == '(') - (c == ')')


def is_constant(declaration):
    """Whether none of its declarators can change: a pointer needs const after its last star."""
    pointer = POINTER_TO_FUNCTION.search(declaration)
    if pointer:
        return 'const' in pointer.group(1).split()
    kind = declaration.split(',')[0]
    base = 'const' in kind.split('*')[0].split()
    return all('const' in re.findall(r'\w+', part.rsplit('*', 1)[1]) if '*' in part else base
               for part in declaration.split(','))


def is_kept(in_function, declaration):
    if not declaration or NOT_AN_OBJECT.match(declaration):
        return False
    if in_function and not LASTS.search(declaration):
        return False
    declaration = BOUNDS.sub('', ATOMIC.sub(r'\1', ASIDE.sub(' ', declaration)))
    if len(WORD.findall(SPECIFIER.sub('', declaration))) < 2:
        return False                        # specifiers alone, of a macro
    is_function = re.search(r'\w+ *\(', POINTER_TO_FUNCTION.sub('', declaration)) and \
        not POINTER_TO_FUNCTION.search(declaration)
    return not is_function and not is_constant(declaration)


def main(paths):
    bad = 0
    for path in paths:
        with open(path, encoding='utf-8') as file:
            text = NOISE.sub(' ', file.read()).replace('\\\n', ' ')
        code = DIRECTIVE.sub('', text)
        for body in MACRO.findall(text):
            code += ' void macro(void) { ' + body.replace('{', ' ').replace('}', ' ') + ' ; }\n'
        for in_function, declaration in statements(code):
            if is_kept(in_function, declaration):
                print(f'{path}: keeps: {declaration}')
                bad = 1
    return bad


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
