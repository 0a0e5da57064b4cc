# SPDX-License-Identifier: MIT
"""What the reports with plots share: files that are the same for the same figures, and pages whose tables are made
anew between two marks."""
import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402: the backend is chosen first

matplotlib.rcParams['svg.hashsalt'] = 'raygrid'


def save(figure, folder, name):
    """As SVG and PNG, without a date or random names."""
    figure.savefig(folder / f'{name}.svg', metadata={'Date': None})
    figure.savefig(folder / f'{name}.png', dpi=110, metadata={'Software': None})
    plt.close(figure)


def replace_figures(page, script, text):
    """The page with `text` between the marks of the script."""
    begin, end = f'<!-- figures: made by {script} -->', '<!-- end of figures -->'
    before, rest = page.split(begin)
    after = rest.split(end)[1]
    return f'{before}{begin}\n\n{text}\n\n{end}{after}'
