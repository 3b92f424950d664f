"""The commands of ``linkwright`` that ``linkwright-core`` does not have."""

GROUPS = {
    "learning": {
        "learn": "a course from the first link to spoken commands, whose steps are checked",
    },
    "robot descriptions": {
        "view": "show a URDF or xacro file in the browser, with joint sliders",
        "diagram": "draw links and joints as urdf_to_graphviz does (.gv and PDF or SVG)",
        "review": "report how commits change robots, worlds and launch files, for a pull request",
        "bisect": "find the commit that moved a link, or changed the result of a command",
        "export": "write a robot as one HTML file for any browser, or as glTF (.glb)",
    },
    "packages and launch files": {
        "launch": "run a ROS 2 launch file; rviz2 opens as a page in the browser",
        "run": "run an executable of a package, built or from its sources",
        "test": "run the launch_testing tests of a file",
        "pkg": "create ROS packages, find them, and list their contents",
        "arm": "set up an arm for planning: write a MoveIt configuration package",
    },
    "simulation": {
        "drive": "drive a robot in a simulated world; missing masses, collisions and wheels are inferred",
        "sim": "simulate a world, with or without a robot, in the browser or headless",
        "world": "list worlds and models, create a world, or check one",
        "spawn": "add a robot or model to a running simulation",
        "sweep": "run a scenario over parameters and seeds in parallel, and tabulate the results",
    },
    "vision and voice": {
        "vision": "detect objects in images; train and evaluate detectors",
        "dataset": "render labeled images of a world in COCO and YOLO format, to train a detector",
        "voice": "try speech engines on recordings, and enroll words",
        "models": "download, verify and remove models for speech and vision",
    },
    "the running ROS graph": {
        "topic": "list, print, publish and measure topics",
        "node": "list and describe nodes",
        "param": "list, read and set parameters of nodes",
        "service": "list and call services",
        "action": "list actions and send goals",
        "interface": "list and show types of messages, services and actions",
        "lifecycle": "show and change the states of managed nodes",
        "component": "load, list and unload components in containers",
        "control": "show and change the controllers and hardware of ros2_control",
    },
    "bags": {
        "bag": "record topics, play recordings, and describe them",
    },
    "network and diagnosis": {
        "doctor": "explain what is wrong with the running nodes, topics and frames",
        "bridge": "carry topics and services between DDS and Zenoh",
        "multicast": "send or receive a datagram, to test multicast on the network",
        "daemon": "accepted for compatibility with ros2; Linkwright has no daemon",
    },
    "shell and editors": {
        "lsp": "serve editors: findings as you type, completion, hover, definitions, formatting",
        "shell": "open a shell with ros2, launch_test, xacro, check_urdf, urdf_to_graphviz, rviz2 and colcon",
        "completion": "print the completion script for bash, zsh or fish",
    },
}
"""The commands in the order in which the help lists them, with their help texts.

Each command is a module or package of this package, which is loaded only when the command runs.
"""

OTHER_NAMES = {"wtf": "doctor"}
"""Aliases that ros2 has for commands. The help does not list them."""

ORDERED_COMMANDS = frozenset({"pkg", "run", "shell"})
"""Commands that do not accept options between positional arguments.

Their last arguments belong to another program. Commands with subcommands do not accept such options either.
Other commands accept `launch PACKAGE --no-open FILE`.
"""

_GRAPH_GROUPS = ("the running ROS graph", "bags", "network and diagnosis")

EVENT_LOOP_COMMANDS = frozenset({"view", "drive", "run", "sim", "spawn", "launch"}).union(
    *(GROUPS[title] for title in _GRAPH_GROUPS)
)
"""Commands that run an event loop or another program, and handle Ctrl-C themselves."""
