"""The searches of a review for files that still use what is gone, in the order of their lines."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Change
from linkwright.review.chosen_robots import find_chosen_robots
from linkwright.review.launches.arguments.ignored import find_ignored_arguments
from linkwright.review.launches.arguments.passed import find_passed_arguments, find_refused_arguments
from linkwright.review.launches.left_nodes import find_left_nodes
from linkwright.review.launches.left_parameters import find_left_parameters
from linkwright.review.launches.loaded_plugins import find_undeclared_plugins
from linkwright.review.launches.programs.missing import find_missing_programs, find_old_package_names
from linkwright.review.launches.programs.script_callers import find_lost_arguments
from linkwright.review.launches.python.helper_failures import find_helper_failures
from linkwright.review.sources.headers.lost_methods import find_lost_methods
from linkwright.review.sources.headers.lost_types import find_lost_types
from linkwright.review.sources.left_types import find_left_types
from linkwright.review.sources.python_callers import find_broken_callers
from linkwright.review.users.faulty_code import find_faulty_code
from linkwright.review.users.ignored_packages import find_ignored_packages
from linkwright.review.users.left_remappings import find_left_remappings
from linkwright.review.users.lost_controllers import find_lost_controllers
from linkwright.review.users.lost_data import find_lost_data
from linkwright.review.users.lost_description_arguments import (
    find_lost_description_arguments,
    find_undeclared_description_arguments,
)
from linkwright.review.users.lost_display_classes import find_lost_display_classes
from linkwright.review.users.lost_displays import find_lost_displays
from linkwright.review.users.lost_entry_points import find_lost_entry_points
from linkwright.review.users.lost_installs import find_lost_installs, find_uninstalled_paths
from linkwright.review.users.lost_interfaces import find_lost_interfaces
from linkwright.review.users.lost_libraries import find_lost_libraries, find_unbuilt_libraries
from linkwright.review.users.lost_lifecycles import find_lost_lifecycles
from linkwright.review.users.lost_programs import find_lost_programs
from linkwright.review.users.lost_registrations import find_lost_registrations
from linkwright.review.users.lost_scripts import find_lost_scripts
from linkwright.review.users.lost_sources import find_lost_sources
from linkwright.review.users.lost_states import find_lost_joints, find_lost_states
from linkwright.review.users.lost_units import find_lost_units
from linkwright.review.users.missing_fields import find_missing_fields
from linkwright.review.users.missing_headers import find_missing_headers
from linkwright.review.users.new_keys import find_new_keys
from linkwright.review.users.old_dependencies import find_old_dependencies
from linkwright.review.users.package_lookups import find_new_lookups
from linkwright.review.users.silent_scripts import find_silent_scripts
from linkwright.review.users.unknown_joints import find_unknown_joints
from linkwright.review.users.unusable_programs import find_unusable_programs
from linkwright.review.versions import Versions

Search = Callable[[Versions, Sequence[ChangedFile]], Iterable[tuple[str, Change]]]
"""A function that yields the path of each user, and the line about it."""

SEARCHES: tuple[Search, ...] = (
    *(find_broken_callers, find_lost_arguments, find_lost_types, find_lost_methods, find_chosen_robots),
    *(
        find_lost_displays,
        find_lost_display_classes,
        find_lost_lifecycles,
        find_lost_controllers,
        find_lost_data,
        find_lost_description_arguments,
        find_undeclared_description_arguments,
        find_lost_installs,
        find_uninstalled_paths,
    ),
    *(find_lost_libraries, find_lost_programs, find_lost_registrations, find_lost_sources, find_missing_programs),
    *(find_unbuilt_libraries, find_old_package_names, find_old_dependencies),
    *(
        find_passed_arguments,
        find_refused_arguments,
        find_ignored_arguments,
        find_left_nodes,
        find_left_parameters,
        find_lost_interfaces,
        find_left_types,
        find_missing_fields,
    ),
    *(find_new_lookups, find_lost_joints, find_lost_states, find_lost_units, find_silent_scripts, find_lost_scripts),
    *(find_unusable_programs, find_undeclared_plugins, find_left_remappings, find_ignored_packages),
    *(find_unknown_joints, find_new_keys, find_missing_headers, find_helper_failures, find_faulty_code),
    find_lost_entry_points,
)
