# SPDX-License-Identifier: Apache-2.0
"""Installs the node, and into the share folder everything that ROS tools look for there."""

from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = 'my_robot_arm'
SHARE = Path('share') / PACKAGE

# Installed with all the folders inside them, so that a new file or folder needs no change here.
SHARED_FOLDERS = ['config', 'launch', 'urdf']


def shared_files():
    """Yield (installed folder, [file]) for every file, as `data_files` wants them."""
    for top in SHARED_FOLDERS:
        for path in sorted(Path(top).rglob('*')):
            if path.is_file() and path.suffix != '.pyc':
                yield str(SHARE / path.parent), [str(path)]


setup(
    name=PACKAGE,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        # The marker through which ROS 2 finds an installed package by its name.
        ('share/ament_index/resource_index/packages', ['resource/' + PACKAGE]),
        (str(SHARE), ['package.xml']),
        *shared_files(),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    author='The Linkwright authors',
    author_email='maintainers@linkwright.dev',
    maintainer='The Linkwright authors',
    maintainer_email='maintainers@linkwright.dev',
    description="mbot's bigger sister with an arm, and a node that picks up what its camera sees.",
    license='Apache-2.0',
    extras_require={'test': ['pytest']},
    entry_points={'console_scripts': ['pick_and_place = my_robot_arm.pick_and_place:main']},
)
