# SPDX-License-Identifier: MIT
"""The demo's renderer as it converges: demo.py DEMO FILE [--quick]. Renders one frame with more and more samples a
pixel, with each kind of grid, and writes for each a line of JSON: seconds of tracing, and the root of the mean square
difference from a picture of many samples, over the linear colours of all pixels."""
import argparse
import json
import pathlib
import re
import resource
import subprocess
import tempfile
import time

import numpy
import OpenEXR

REFERENCE = 256  # samples a pixel, the most that the demo takes
TIMES = 3        # each is timed so often; the least counts


def processor_seconds():
    """Of all programs that were run and have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def render(demo, folder, kind, samples, size):
    """The linear colours, and the processor seconds that tracing took: those of the clock, less what others took."""
    wall, processor = time.perf_counter(), processor_seconds()
    arguments = [demo, '--frames', '1', '--size', f'{size}x{size}', '--samples', str(samples), '--sample', '0',
                 '--workers', '1', '--grid', kind, '--out', folder]
    done = subprocess.run(arguments, check=True, capture_output=True, text=True)
    share = min((processor_seconds() - processor) / (time.perf_counter() - wall), 1)
    primary, shadow = re.search(r'primary ([\d.]+) ms, shadow ([\d.]+) ms', done.stdout).groups()
    with OpenEXR.File(str(pathlib.Path(folder) / 'frame-0000.exr'), separate_channels=True) as file:
        colours = numpy.stack([file.channels()[name].pixels.astype(float) for name in 'RGB'])
    return colours, 1e-3 * (float(primary) + float(shadow)) * share


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('demo')
    parser.add_argument('file', help='receives the lines')
    parser.add_argument('--quick', action='store_true', help='a small picture, few samples')
    arguments = parser.parse_args()
    size, most = (64, 8) if arguments.quick else (256, 64)
    with tempfile.TemporaryDirectory() as folder, open(arguments.file, 'w', encoding='utf-8') as file:
        truth, _ = render(arguments.demo, folder, 'default', REFERENCE, size)
        for kind in ('loose', 'uniform', 'hierarchical'):
            samples = 1
            while samples <= most:
                runs = [render(arguments.demo, folder, kind, samples, size) for _ in range(TIMES)]
                error = float(numpy.sqrt(numpy.mean((runs[0][0] - truth) ** 2)))
                line = {'scene': 'demo', 'side': kind, 'size': size, 'samples': samples,
                        'seconds': min(seconds for _, seconds in runs), 'rmse': error}
                print(json.dumps(line), file=file, flush=True)
                samples *= 2


if __name__ == '__main__':
    main()
