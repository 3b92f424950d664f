"""The installed files of a setup.py with loops and functions."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from linkwright.diagnostics import SourceText
from linkwright.packages.readers.setup_py import read_setup

FILES = (
    *("package.xml", "setup.cfg", "launch/show.launch.py", "launch/parts/more.launch.py", "config/arm.yaml"),
    *("models/cup/model.sdf", "models/cup/meshes/cup.dae", "models/box/model.sdf", "models/notes.txt"),
    *("description/urdf/arm.xacro", "description/.hidden", "launch/__pycache__/show.pyc"),
)
HEAD = """
import os
import glob as globbing
from glob import glob
from itertools import chain
from pathlib import Path
from setuptools import setup
name = 'arm'
"""
WALK = "for root, folders, files in os.walk('models'):"
STYLES = {
    "a function that walks": """
def files_of(folder):
    found = []
    for (root, folders, files) in os.walk(folder):
        for file in files:
            found.append(('share/' + name + '/' + root, [root + '/' + file]))
    return found
setup(data_files=[('share/arm', ['package.xml'])] + files_of('models') + files_of('none'))
""",
    "a loop that appends": f"""
data = [('share/arm', ['package.xml'])]
{WALK}
    to = os.path.join('share', name, root.replace('models', 'things', 1))
    data.append((to, [os.path.join(root, f) for f in files]))
setup(name=name, data_files=data)
""",
    "a comprehension": """
models = [(os.path.join('share', name, root), [os.path.join(root, f) for f in files if not f.startswith('.')])
          for root, _, files in os.walk('description')]
setup(data_files=[*models, ('share/arm', ['package.xml'])])
""",
    "a prefix that is cut off": """
def generate(folders=['launch', 'description/urdf']):
    found = []
    for path, _, files in chain.from_iterable(os.walk(folder) for folder in folders):
        to = path[len('description/'):] if path.startswith('description/') else path
        found.append((os.path.join('share', name, to), [os.path.join(path, f) for f in files]))
    return found
setup(data_files=generate())
""",
    "folders that are left out while it walks": """
def tree(folder):
    for_all = []
    for root, folders, files in os.walk(folder):
        folders[:] = [entry for entry in folders if entry != '__pycache__']
        paths = [os.path.join(root, entry) for entry in files if not entry.endswith(('.pyc', '.txt'))]
        if paths:
            for_all.append((os.path.join('share', name, root), paths))
    return for_all
data = []
for folder in ('launch', 'models'):
    data.extend(tree(folder))
setup(data_files=data)
""",
    "a list that grows while it is gone through": """
data = []
folders = globbing.glob('models/*')
for folder in folders:
    files = []
    for path in globbing.glob(folder + '/*'):
        if os.path.isdir(path):
            folders.append(path)
        else:
            files.append(path)
    data.append(('share/arm/' + folder, files))
setup(data_files=[('share/arm', ['package.xml'])] + data)
""",
    "a function that calls itself": """
data = [('share/arm', ['package.xml'])]
def all_of(data, folder):
    data.append((os.path.join('share', name, folder), glob(folder + '*.*')))
    below = glob(folder + '*/')
    if below == []:
        return
    else:
        for subfolder in below:
            all_of(data, subfolder)
for folder in ['launch/', 'none/', 'models/']:
    all_of(data, folder)
setup(data_files=data)
""",
    "paths as objects": """
share = Path('share') / name
def tree(folder, to=None):
    return [(str(share / (to or folder) / path.parent.relative_to(folder)), [str(path)])
            for path in Path(folder).rglob('*') if path.is_file() and path.suffix != '.pyc']
setup(data_files=[(str(share), ['package.xml']), *tree('models'), *tree('description', 'robot')])
""",
    "absolute paths": """
here = os.path.abspath(os.path.dirname(__file__))
with open(os.path.join(here, 'package.xml')) as file:
    text = file.read()
folders = {'config': 'params', 'description/urdf': 'urdf'}
setup(long_description=text, data_files=[
    (f'share/{name}/{to}', [os.path.join(here, of, entry) for entry in os.listdir(os.path.join(here, of))])
    for of, to in folders.items()
])
""",
    "arguments in a dictionary": """
arguments = dict(name=name, version='1')
arguments['data_files'] = [('share/%s/%s' % (name, 'urdf'), glob('description/**/*.xacro', recursive=True))]
setup(**arguments)
""",
    "a lambda, filter and format": """
share = lambda *parts: os.path.join('share', name, *parts)
data = [(share(to), list(filter(os.path.isfile, glob(f'{of}/**', recursive=True)))) for of, to in [('models', 'm')]]
data += [('share/{}/{}'.format(name, 'start'), sorted(glob(os.path.join('launch', '*.py'))))]
if os.path.exists('none'):
    data.append(('share/none', ['none/x']))
setup(data_files=data)
""",
    "a function main, and what it cannot know": """
import somewhere
version = somewhere.version()
def main():
    data = [('share/arm', ['package.xml'])]
    data += [('share/arm/config', [os.path.join('config', f) for f in os.listdir('config')])]
    try:
        print(version)
    except ValueError:
        pass
    setup(version=version, data_files=data)
if __name__ == '__main__':
    main()
""",
}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    for name in FILES:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("")
    return tmp_path


def read_files(text: str, package: Path) -> set[tuple[str, str]]:
    facts = read_setup(SourceText(str(package / "setup.py"), text))
    return {(file.source, file.destination) for file in facts.installed_files(package)}


def run_by_python(text: str, package: Path, monkeypatch: pytest.MonkeyPatch) -> set[tuple[str, str]]:
    """Return the arguments of setuptools when Python runs the file."""
    setup_calls: list[Any] = []
    setuptools, somewhere = ModuleType("setuptools"), ModuleType("somewhere")
    vars(setuptools)["setup"] = lambda **arguments: setup_calls.extend(arguments["data_files"])
    vars(somewhere)["version"] = lambda: "1"
    monkeypatch.setitem(sys.modules, "setuptools", setuptools)
    monkeypatch.setitem(sys.modules, "somewhere", somewhere)
    monkeypatch.chdir(package)
    exec(compile(text, "setup.py", "exec"), {"__name__": "__main__", "__file__": "setup.py"})
    return {
        (Path(os.path.relpath(file)).as_posix(), (Path(folder) / Path(file).name).as_posix())
        for folder, files in setup_calls
        for file in files
        if Path(file).is_file()
    }


@pytest.mark.parametrize("style", STYLES)
def test_data_files_match_python_run(style: str, package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = read_files(HEAD + STYLES[style], package)
    assert found
    assert found == run_by_python(HEAD + STYLES[style], package, monkeypatch)


@pytest.mark.parametrize(
    "files",
    [
        "[os.path.join(r, f) for r, _, fs in os.walk('/etc') for f in fs]",
        "[os.path.join('..', f) for f in os.listdir('..')]",
        "glob('../*') + glob('/etc/*') + [path for path in ()]",
        "[str(p) for p in Path('..').glob('*')]",
        "[str(p) for p in Path('models').glob('../../*')]",
        "[().__class__.__base__.__subclasses__()]",
        "['{0.__class__}'.format(name)]",
        "[__import__('os').getcwd()]",
        "[open('package.xml').name]",
        "[eval('name')]",
    ],
)
def test_setup_py_reads_nothing_outside_package_and_runs_nothing(files: str, package: Path) -> None:
    text = f"""{HEAD}
for folder in ['a']:
    data = [('share/arm', ['package.xml']), ('share/arm/x', {files})]
setup(data_files=data)
"""
    assert read_files(text, package) == {("package.xml", "share/arm/package.xml")}


@pytest.mark.parametrize(
    "statements",
    [
        "def again(x):\n    return again(x)\nagain(1)",
        "items = [1]\nfor item in items:\n    items.append(item)",
        "text = 'x'\nfor number in range(100):\n    text = text + text",
        "'%999999999d' % 1\n'{:999999999}'.format(1)",
        "items = ['x' * 10 ** 9]\nfor number in range(10 ** 12):\n    items.extend(items)",
        "for a in range(10 ** 5):\n    for b in range(10 ** 5):\n        c = [a, b]",
        "while True:\n    pass",
        "x = [1]\nfor number in range(60):\n    x = [x, x]\ntext = str(x)",
        "x = [1]\nfor n in range(60):\n    y = []\n    y.append(x)\n    y.append(x)\n    x = y\nsame = x == [x, x]",
        "x = (1,)\nfor number in range(60):\n    x = (x, x)\nkeys = {x: 1}",
        "x = {}\nx['own'] = x\ntext = f'{x}' + '%s' % x",
    ],
)
def test_expensive_statements_are_abandoned(statements: str, package: Path) -> None:
    text = HEAD + f"{statements}\nsetup(data_files=[('share/arm', ['package.xml']), *more])\n"
    assert read_files(text, package) <= {("package.xml", "share/arm/package.xml")}
