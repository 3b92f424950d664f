from glob import glob

from setuptools import find_packages, setup

package_name = 'my_vision'

setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages',
            ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        ('share/' + package_name + '/launch', glob('launch/*')),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='learner',
    maintainer_email='learner@example.org',
    description='Nodes that see',
    license='MIT',
    extras_require={'test': ['pytest']},
    entry_points={
        'console_scripts': [
            'red_mask = my_vision.red_mask:main',
            'ball_finder = my_vision.ball_finder:main',
            'marker_finder = my_vision.marker_finder:main',
            'watch_ball = my_vision.watch_ball:main',
        ],
    },
)
