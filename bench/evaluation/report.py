# SPDX-License-Identifier: MIT
"""Turns what the evaluation wrote into the report: report.py FIGURES PAGE FOLDER. The tables of PAGE
(docs/evaluation.md) are made anew between its marks, the plots and the JSON of FOLDER all."""
import argparse
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from plots import plt, replace_figures, save  # noqa: E402: found only now

import tables  # noqa: E402

LOOKS = {  # marker and colour of each side
    'uniform': ('s', '#4aa3c7'), 'uniform, tiles': ('^', '#2a7f62'), 'uniform, eight tiles': ('v', '#8fbf4d'),
    'hierarchical': ('D', '#7b5ea7'), 'loose': ('o', '#1b6ca8'), 'peer': ('x', '#c0392b'),
}
MANNERS = {'rebuild in the frame': '#c0392b', 'never rebuilt': '#999999', 'rebuild in background': '#2a7f62'}


def lines_with_marks(axes, side, x, y, label=None, **more):
    marker, colour = LOOKS[side]
    axes.plot(x, y, marker=marker, color=colour, label=label or side, markersize=5, **more)


def draw_resolutions(records, folder):
    """Above frames, below updates a second; grids that have no resolution are level lines."""
    scenes = tables.each(records, 'scene')
    figure, grid = plt.subplots(2, len(scenes), figsize=(3.6 * len(scenes) + 1, 7.5), sharex=True, sharey='row',
                                layout='constrained', squeeze=False)
    for column, scene in enumerate(scenes):
        of_scene = [r for r in records if r['scene'] == scene]
        resolutions = sorted({r['resolution'] for r in of_scene if r['resolution']})
        for axes, key in zip(grid[:, column], ('frames a second', 'updates a second')):
            for side in tables.each(of_scene, 'side'):
                points = [r for r in of_scene if r['side'] == side]
                if points[0]['resolution'] is None:
                    axes.axhline(points[0][key], color=LOOKS[side][1], linestyle='--', label=side)
                else:
                    lines_with_marks(axes, side, [r['resolution'] for r in points], [r[key] for r in points])
            axes.set(xscale='log', yscale='log')
            axes.set_xticks(resolutions, [str(r) for r in resolutions], minor=False)
            axes.minorticks_off()
            axes.grid(alpha=0.25)
        grid[0, column].set_title(f"{scene}, {of_scene[0]['objects']:,} objects")
        grid[1, column].set_xlabel('cells along the longest side')
    grid[0, 0].set_ylabel('frames a second\n(primary and shadow rays, one thread)')
    grid[1, 0].set_ylabel('updates a second\n(all objects move, one thread)')
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc='outside lower center', ncols=len(labels))
    save(figure, folder, 'resolutions')


def draw_shows(records, folder):
    """The rate at which each frame came; dots where a rebuild was made or under way."""
    scenes = tables.each(records, 'scene')
    figure, grid = plt.subplots(len(scenes), 1, figsize=(9, 3.2 * len(scenes) + 0.8), layout='constrained',
                                squeeze=False)
    for axes, scene in zip(grid.flat, scenes):
        of_scene = [r for r in records if r['scene'] == scene]
        for r in of_scene:
            loose = r['kind'] == 'loose'
            colour = LOOKS['loose'][1] if loose else MANNERS[r['manner']]
            rate = [1000 / ms for ms in r['ms']]
            axes.plot(rate, color=colour, linestyle='--' if loose else '-', linewidth=1.3,
                      label='loose grid' if loose else r['manner'])
            busy = [i for i in range(len(rate)) if tables.busy(r, i)]
            axes.plot(busy, [rate[i] for i in busy], color=colour, marker='o', linestyle='', markersize=4)
        first = of_scene[0]
        axes.set(title=f"{scene}, {first['objects']:,} objects, {first['kind']} grid", yscale='log',
                 ylabel='frames a second')
        axes.grid(alpha=0.25)
    grid[-1, 0].set_xlabel('frame: the scene grows to several times its first box')
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc='outside lower center', ncols=len(labels))
    figure.suptitle('Dots: a rebuild was made in this frame or was under way', fontsize=10)
    save(figure, folder, 'shows')


def draw_sizes(records, folder):
    figure, grid = plt.subplots(1, 2, figsize=(11, 4.8), sharey=True, layout='constrained')
    for axes, key, title in zip(grid, ('insert ns', 'remove ns'), ('insert', 'remove')):
        for kind in tables.each(records, 'kind'):
            points = [r for r in records if r['kind'] == kind]
            lines_with_marks(axes, kind, [r['size'] for r in points], [r[key] for r in points])
        axes.axvline(1 / records[0]['resolution'], color='grey', linestyle=':', linewidth=1)
        axes.set(title=title, xscale='log', yscale='log', xlabel="object's diameter / scene's side")
        axes.grid(alpha=0.25)
    grid[0].set_ylabel('ns a call')
    grid[0].legend()
    figure.suptitle(f"One object of each size into {records[0]['objects']:,} equal ones, resolution "
                    f"{records[0]['resolution']}; dotted: a cell", fontsize=10)
    save(figure, folder, 'sizes')


def draw_counts(records, folder):
    scenes = tables.each(records, 'scene')
    figure, grid = plt.subplots(2, len(scenes), figsize=(4 * len(scenes) + 1, 7.5), sharex=True, sharey='row',
                                layout='constrained', squeeze=False)
    for column, scene in enumerate(scenes):
        of_scene = [r for r in records if r['scene'] == scene]
        for side in tables.each(of_scene, 'side'):
            points = [r for r in of_scene if r['side'] == side]
            objects = [r['objects'] for r in points]
            lines_with_marks(grid[0, column], side, objects, [r['frames a second'] for r in points])
            lines_with_marks(grid[1, column], side, objects, [r['update ns'] for r in points])
            if side == 'peer':
                lines_with_marks(grid[1, column], side, objects, [r['single update ns'] for r in points],
                                 label='peer, one object alone', linestyle=':')
        for axes in grid[:, column]:
            axes.set(xscale='log', yscale='log')
            axes.grid(alpha=0.25)
        grid[0, column].set_title(scene)
        grid[1, column].set_xlabel('objects')
    grid[0, 0].set_ylabel('frames a second\n(primary and shadow rays, one thread)')
    grid[1, 0].set_ylabel('ns an update of an object')
    handles, labels = grid[1, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc='outside lower center', ncols=len(labels))
    save(figure, folder, 'counts')


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ('figures', 'page', 'folder'):
        parser.add_argument(name, type=pathlib.Path)
    arguments = parser.parse_args()
    report = json.loads(arguments.figures.read_text(encoding='utf-8'))
    arguments.folder.mkdir(parents=True, exist_ok=True)
    for name, draw in (('resolutions', draw_resolutions), ('shows', draw_shows), ('sizes', draw_sizes),
                       ('counts', draw_counts)):
        draw(report[name], arguments.folder)
    page = replace_figures(arguments.page.read_text(encoding='utf-8'), 'script/evaluation', tables.markdown(report))
    arguments.page.write_text(page, encoding='utf-8')
    (arguments.folder / 'figures.json').write_text(json.dumps(report) + '\n', encoding='utf-8')


if __name__ == '__main__':
    main()
