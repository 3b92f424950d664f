from pathlib import Path

from setuptools import find_packages, setup

package_name = 'my_robot_description'
share = Path('share') / package_name


def shared_files():
    for top in ['launch', 'rviz', 'urdf']:
        for path in sorted(Path(top).rglob('*')):
            if path.is_file():
                yield str(share / path.parent), [str(path)]


setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages',
            ['resource/' + package_name]),
        (str(share), ['package.xml']),
        *shared_files(),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='learner',
    maintainer_email='learner@example.org',
    description='mbot, a small two-wheeled robot',
    license='MIT',
    extras_require={'test': ['pytest']},
    entry_points={
        'console_scripts': [
        ],
    },
)
