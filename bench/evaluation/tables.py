# SPDX-License-Identifier: MIT
"""The tables of docs/evaluation.md."""
import statistics

NEIGHBOURS = 3  # on either side of a frame
VERDICTS = ('primary', 'shadow', 'moved', 'judged')


def each(records, key):
    """The values of the key, in the order in which they come."""
    return list(dict.fromkeys(r[key] for r in records))


def short(number):
    """Three digits; beyond that thousands and millions."""
    for unit, factor in (('M', 1e6), ('k', 1e3)):
        if number >= 0.9995 * factor:
            return f'{number / factor:.3g} {unit}'
    return f'{number:.3g}'


def table(head, rows):
    lines = [head, ['---'] * len(head), *rows]
    return '\n'.join('| ' + ' | '.join(str(cell) for cell in line) + ' |' for line in lines)


def share(verdicts):
    """Wrong answers of those that were checked."""
    return f"{sum(v['wrong'] for v in verdicts)} / {sum(v['checked'] for v in verdicts)}"


def errors(records):
    return share([r[key] for r in records for key in ('primary', 'shadow', 'moved')])


def about(run):
    load = ' to '.join(f'{minutes[0]:.1f}' for minutes in (run['load before'], run['load after']) if minutes)
    return (f"Run on {run['date']} in {run['seconds']:.0f} s ({run['effort']}): raygrid {run['raygrid']} "
            f"({run['instructions']}), {run['compiler']}, {run['peer'] or 'no peer'}; {run['processors']} processors "
            f"({run['processor'] or 'unknown'}), load average {load}; pictures of {run['side']}x{run['side']} rays.")


def resolutions(records, key, form):
    """A row a side, a column a resolution; what has none has one figure."""
    columns = sorted({r['resolution'] for r in records if r['resolution']})
    rows = []
    for scene in each(records, 'scene'):
        of_scene = [r for r in records if r['scene'] == scene]
        for side in each(of_scene, 'side'):
            at = {r['resolution']: r for r in of_scene if r['side'] == side}
            if None in at:
                cells = [form(at[None][key])] + [''] * (len(columns) - 1)
            else:
                cells = [form(at[c][key]) for c in columns]
            rows.append([scene, side, *cells, errors(at.values())])
    return table(['scene', 'side', *columns, 'wrong / checked'], rows)


def equal_sizes(records):
    """Of the scene of equal sizes: where each of the paper's kinds is best, and what it does there."""
    rows = []
    for side in ('uniform', 'hierarchical'):
        best = max((r for r in records if r['scene'] == 'equal' and r['side'] == side),
                   key=lambda r: r['frames a second'])
        rows.append([side, best['resolution'], short(best['frames a second']), f"{best['cells a ray']:.1f}",
                     f"{best['tests a ray']:.1f}", f"{best['update ns']:.0f}", f"{best['bytes an object']:.0f}"])
    return table(['grid', 'best resolution', 'frames/s', 'cells a ray', 'tests a ray', 'ns an update',
                  'bytes an object'], rows)


def busy(show, frame):
    return show['rebuilt'][frame] or show['rebuilding'][frame]


def ratio(show, frame, key):
    """Of a frame's time to that of its neighbours that saw nothing of a rebuild: the median of those before it or of
    those after it, whichever is longer, for a grid that suits the scene better or worse than the last is no dip."""
    quiet = [i for i in range(len(show['ms'])) if not busy(show, i) and i != frame]
    sides = [[i for i in quiet if i < frame][-NEIGHBOURS:], [i for i in quiet if i > frame][:NEIGHBOURS]]
    return show[key][frame] / max(statistics.median(show[key][i] for i in side) for side in sides if side)


def largest(show, wanted):
    """The largest ratio of such frames, by the wall clock and by processor time; the first frames warm up."""
    frames = [i for i in range(NEIGHBOURS, len(show['ms'])) if busy(show, i) == wanted]
    if not frames:
        return '-'
    return ' / '.join(f'{max(ratio(show, i, key) for i in frames):.2f}' for key in ('ms', 'processor ms'))


def shows(records):
    rows = []
    for r in records:
        frames = [i for i in range(len(r['ms'])) if busy(r, i)]
        rows.append([r['scene'], r['kind'], r['manner'] if r['kind'] != 'loose' else 'needs none',
                     f"{statistics.median(r['ms']):.1f}", f"{statistics.median(r['processor ms']):.1f}",
                     f"{statistics.median(r['update ms']):.1f}",
                     f"{statistics.mean(r['ms'][-8:]):.1f}", len(frames), largest(r, True), largest(r, False),
                     r['tiles'][-1], share([r['judged']])])
    return table(['scene', 'grid', 'manner', 'ms a frame, median', 'processor ms', 'update ms',
                  'the last 8 frames, ms', 'frames with a rebuild', 'largest ratio of these, wall / processor',
                  'of the others', 'tiles at the end', 'wrong / checked'], rows)


def sizes(records):
    kinds = each(records, 'kind')
    rows = []
    for size in each(records, 'size'):
        at = {r['kind']: r for r in records if r['size'] == size}
        rows.append([f'1/{1 / size:.0f}',
                     *(f"{short(at[kind]['insert ns'])} / {short(at[kind]['remove ns'])}" for kind in kinds),
                     share([r['judged'] for r in at.values()])])
    return table(['diameter / side', *(f'{kind}: insert / remove, ns' for kind in kinds), 'wrong / checked'], rows)


def counts(records):
    sides = each(records, 'side')
    rows = []
    for scene in each(records, 'scene'):
        for objects in each([r for r in records if r['scene'] == scene], 'objects'):
            at = {r['side']: r for r in records if r['scene'] == scene and r['objects'] == objects}
            rows.append([scene, f'{objects:,}',
                         *(f"{short(at[s]['frames a second'])} / {short(at[s]['update ns'])}" for s in sides),
                         *([short(at['peer']['single update ns'])] if 'peer' in sides else []),
                         share([at[s][key] for s in sides if s != 'peer' for key in ('primary', 'shadow', 'moved')]),
                         *([errors([at['peer']])] if 'peer' in sides else [])])
    head = ['scene', 'objects', *(f'{side}: frames/s / ns an update' for side in sides)]
    if 'peer' in sides:
        return table([*head, 'peer: ns of one update alone', 'wrong / checked', "peer's"], rows)
    return table([*head, 'wrong / checked'], rows)


def goal(records):
    return table(['spheres', 'threads', 'frames/s', 'ms a frame, median', 'best', 'processor ms', 'wrong / checked'],
                 [[f"{r['objects']:,}", r['threads'], f"{r['frames a second']:.1f}", f"{r['median ms']:.1f}",
                   f"{r['best ms']:.1f}", f"{r['processor ms']:.1f}", share([r['primary'], r['shadow']])]
                  for r in records])


def totals(report):
    """Of all experiments; of the peer apart."""
    verdicts = {True: [], False: []}
    for records in report.values():
        for r in records if isinstance(records, list) else []:
            verdicts[r.get('side') == 'peer'] += [r[key] for key in VERDICTS if key in r]
    return f"Wrong answers of those that were checked: raygrid {share(verdicts[False])}, peer {share(verdicts[True])}."


def markdown(report):
    parts = [
        about(report['run']) + ' ' + totals(report),
        '**(a) Frames a second**, primary and shadow rays, by the resolution of the grid; one thread:',
        resolutions(report['resolutions'], 'frames a second', short),
        '**(b) Updates a second**, all objects moving, by the resolution of the grid; one thread:',
        resolutions(report['resolutions'], 'updates a second', short),
        '**(c) The shows**, two threads, by the wall clock:',
        shows(report['shows']),
        '**(d) Insert and remove by size**, one call each:',
        sizes(report['sizes']),
        'and where all sizes are equal, each grid at the resolution that suits it best:',
        equal_sizes(report['resolutions']),
        '**(e) More and more objects**, the grids left to choose their resolution; one thread:',
        counts(report['counts']),
        '**Thirty frames a second**, a tenth of all spheres moving, primary and shadow rays, by the wall clock:',
        goal(report['goal']),
    ]
    return '\n\n'.join(parts)
