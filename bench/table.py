# SPDX-License-Identifier: MIT
"""Turns the lines that the benchmark wrote with --json into the tables of docs/performance.md:
table.py FILE [--only SECTION,...]. One table a section; goals that were missed are bold."""
import argparse
import json
import sys

HEAD = ('| what | figure | | peer | ratio | goal | wrong | t error | peer: wrong | t error | peer: way |\n'
        '|---|---|---|---|---|---|---|---|---|---|---|')

CALLS_HEAD = ('| single calls, us | all: p50 | p99 | p99.9 | p99.99 | max | undisturbed: p99.99 | max '
              '| best: p99.99 | max | goal for p99.99 | wrong |\n'
              '|---|---|---|---|---|---|---|---|---|---|---|---|')


def short(number):
    """Three digits, thousands whole."""
    if number is None:
        return ''
    return f'{number:.0f}' if abs(number) >= 1000 else f'{number:.3g}'


def goal(line):
    if line['goal'] is None:
        return ''
    text = ('>= ' if line['goal_on'].startswith('ratio') else '<= ') + short(line['goal'])
    return f'**{text}**' if line['reached'] is False else text


def errors(line, side):
    if line[side + 'checked'] is None:
        return '', ''
    error = line[side + 'worst_t_error']
    return f"{line[side + 'wrong']} of {line[side + 'checked']}", f'{error:.0e}' if error else '0'


def row(line):
    what = line['name'].split('/', 1)[1]
    cells = [what, short(line['figure']), line['unit'], short(line['peer_figure']), short(line['ratio']), goal(line),
             *errors(line, ''), *errors(line, 'peer_'), line['peer_way'] or '']
    return '| ' + ' | '.join(cells) + ' |'


def row_of_calls(line):
    """Times of single calls: all, those that the machine left alone, the best of several runs of each."""
    cells = [line['name'].split('/', 1)[1]]
    for view, parts in (('all', ('p50', 'p99', 'p99.9', 'p99.99', 'max')), ('undisturbed', ('p99.99', 'max')),
                        ('best', ('p99.99', 'max'))):
        times = line['spread'][view] or {}
        cells += [short(times.get(part)) for part in parts]
    cells += [goal(line), errors(line, '')[0]]
    return '| ' + ' | '.join(cells) + ' |'


def tables(section, lines):
    """Of the section's figures, and of its times of single calls."""
    figures = [row(line) for line in lines if not line['spread']]
    calls = [row_of_calls(line) for line in lines if line['spread']]
    parts = [f'### {section}']
    if figures:
        parts.append('\n'.join([HEAD, *figures]))
    if calls:
        parts.append('\n'.join([CALLS_HEAD, *calls]))
    return parts


def markdown(lines):
    """All tables, with what ran above them and what was missed below."""
    parts = []
    if lines:
        first = lines[0]
        versions = first['versions']
        parts.append(f"raygrid {versions['raygrid']} (instructions: {first['isa']}), {versions['compiler']}; "
                     f"peer: {versions['peer'] or 'none'}.")
    for section in dict.fromkeys(line['name'].split('/')[0] for line in lines):
        parts += tables(section, [line for line in lines if line['name'].split('/')[0] == section])
    missed = [line for line in lines if line['reached'] is False]
    aimed = sum(line['reached'] is not None for line in lines)
    parts.append(f'{aimed - len(missed)} of {aimed} goals reached; '
                 f"wrong hits: raygrid {sum(line['wrong'] or 0 for line in lines)}, "
                 f"peer {sum(line['peer_wrong'] or 0 for line in lines)}.")
    return '\n\n'.join(parts) + '\n'


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('file', help='what --json wrote')
    parser.add_argument('--only', help='sections, separated by commas')
    arguments = parser.parse_args()
    with open(arguments.file, encoding='utf-8') as file:
        lines = [json.loads(text) for text in file]
    if arguments.only:
        wanted = set(arguments.only.split(','))
        lines = [line for line in lines if line['name'].split('/')[0] in wanted]
    sys.stdout.write(markdown(lines))


if __name__ == '__main__':
    main()
