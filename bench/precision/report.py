# SPDX-License-Identifier: MIT
"""Turns what the precision programs wrote into the report: report.py FIGURES DEMO PAGE FOLDER. The tables of PAGE
(docs/precision.md) are made anew between its marks, the plots and the JSON of FOLDER all."""
import argparse
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from plots import plt, replace_figures, save  # noqa: E402: found only now
from matplotlib.lines import Line2D  # noqa: E402: plots chooses the backend first

ROUNDINGS, PROMISE = 'by four roundings of floats', 'by the promise'
LOOKS = {  # marker and colour of each side
    'loose': ('o', '#1b6ca8'), 'uniform': ('s', '#4aa3c7'), 'hierarchical': ('D', '#7b5ea7'),
    'peer, robust': ('^', '#c0392b'), 'peer, fast': ('v', '#e67e22'),
    'peer, robust, moved by its host': ('<', '#7f6a00'),
}


def lines_of(path):
    with open(path, encoding='utf-8') as file:
        return [json.loads(text) for text in file]


def power(number, digits=0):
    return f'{number:.{digits}e}'.replace('e+0', 'e').replace('e+', 'e')


def scene_of(line):
    return line['scene'] if line['offset'] == 0 else f"{line['scene']}, offset {power(line['offset'])}"


def scenes_of(lines):
    return list(dict.fromkeys(map(scene_of, lines)))


def short(number):
    if number is None:
        return '-'
    if number == 0:
        return '0'
    return power(number, 1) if number >= 1000 else f'{number:.0f}' if number >= 10 else f'{number:.2g}'


def spread(values):
    return ' / '.join(short(values[name]) for name in ('median', '99 %', 'most'))


def share(line, rule):
    counts = line[rule]
    return '' if counts is None else f"{counts['wrong']} / {counts['missed']} / {counts['within']}"


def table(lines):
    rows = ['| scene | side | ns a ray | by the promise: wrong / missed / in doubt | by floats: the same | '
            't error, ulp of double: median / 99 % / most | normal error, ulp of float: the same |', '|---' * 7 + '|']
    for line in lines:
        rows.append(f"| {scene_of(line)} | {line['side']} | {line['ns']:.0f} | {share(line, PROMISE)} | "
                    f"{share(line, ROUNDINGS)} | {spread(line['t ulp'])} | {spread(line['normal ulp'])} |")
    return '\n'.join(rows)


def demo_table(lines):
    sides = list(dict.fromkeys(line['side'] for line in lines))
    rows = ['| samples a pixel | RMSE | ' + ' | '.join(f'{side}, s' for side in sides) + ' |',
            '|---' * (2 + len(sides)) + '|']
    for samples in dict.fromkeys(line['samples'] for line in lines):
        at = {line['side']: line for line in lines if line['samples'] == samples}
        rows.append(f"| {samples} | {at[sides[0]]['rmse']:.3g} | " +
                    ' | '.join(f"{at[side]['seconds']:.3g}" for side in sides) + ' |')
    return '\n'.join(rows)


def mark(axes, line, top):
    """A side's place: time across, error up. What is wrong is written beside it."""
    marker, colour = LOOKS[line['side']]
    error = line['t ulp']['99 %']
    axes.plot(line['ns'], max(error, 0.1) if error is not None else top, marker=marker, color=colour, linestyle='',
              markersize=8, fillstyle='full' if error is not None else 'none', clip_on=False)
    counts = line[ROUNDINGS]
    bad = counts['wrong'] + counts['missed']
    if bad:
        left = line['ns'] > 1e4
        axes.annotate(f"{100 * bad / line['judged']:.3g} % wrong", (line['ns'], error if error is not None else top),
                      xytext=(-8 if left else 8, -10 if line['side'] == 'peer, fast' else 6), color=colour,
                      ha='right' if left else 'left', textcoords='offset points', fontsize=8)


def draw_errors(lines, folder):
    scenes = scenes_of(lines)
    columns = 3
    figure, grid = plt.subplots(-(-len(scenes) // columns), columns, figsize=(13, 11), sharex=True, sharey=True,
                                layout='constrained', squeeze=False)
    top = 1e18
    for axes, scene in zip(grid.flat, scenes):
        for line in lines:
            if scene_of(line) == scene:
                mark(axes, line, top)
        axes.set(title=scene, xscale='log', yscale='log', ylim=(0.1, 10 * top), xlim=(20, 1e5))
        axes.axhline(2 ** 29, color='grey', linewidth=0.7, linestyle=':')
        axes.grid(alpha=0.25)
    for axes in grid[-1]:
        axes.set_xlabel('ns a ray')
    for row in grid:
        row[0].set_ylabel('error of t: 99 of 100 rays\nare better (ulp of double)')
    handles = [Line2D([], [], marker=marker, color=colour, linestyle='', markersize=8)
               for marker, colour in LOOKS.values()]
    figure.legend(handles, LOOKS.keys(), loc='outside lower center', ncols=len(LOOKS))
    figure.suptitle('Error against run time: lower left is better. Dotted: an ulp of float. Hollow, at the top: '
                    'names no object rightly. Without a note: 0 wrong and missed', fontsize=11)
    save(figure, folder, 'errors')


def draw_demo(lines, folder):
    figure, axes = plt.subplots(figsize=(7, 5), layout='constrained')
    for side in dict.fromkeys(line['side'] for line in lines):
        of_side = [line for line in lines if line['side'] == side]
        marker, colour = LOOKS[side]
        axes.plot([line['seconds'] for line in of_side], [line['rmse'] for line in of_side], marker=marker,
                  color=colour, label=side)
    axes.set(xscale='log', yscale='log', xlabel='seconds of tracing, one thread', ylabel='RMSE of linear colours',
             title='The demo: 1, 2, 4, ... samples a pixel against many')
    axes.grid(alpha=0.25, which='both')
    axes.legend()
    save(figure, folder, 'demo')


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ('figures', 'demo', 'page', 'folder'):
        parser.add_argument(name, type=pathlib.Path)
    arguments = parser.parse_args()
    figures, demo = lines_of(arguments.figures), lines_of(arguments.demo)
    arguments.folder.mkdir(parents=True, exist_ok=True)
    draw_errors(figures, arguments.folder)
    text = table(figures)
    if demo:
        draw_demo(demo, arguments.folder)
        text += '\n\n' + demo_table(demo)
    page = replace_figures(arguments.page.read_text(encoding='utf-8'), 'script/precision', text)
    arguments.page.write_text(page, encoding='utf-8')
    for name, lines in (('figures', figures), ('demo', demo)):
        (arguments.folder / f'{name}.json').write_text(json.dumps(lines, indent=1) + '\n', encoding='utf-8')


if __name__ == '__main__':
    main()
