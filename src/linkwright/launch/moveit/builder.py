"""Builders of parameters (``moveit_configs_utils``, ``launch_param_builder``)."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Note, Severity, display_path, joined, phrase, print_diagnostics
from linkwright.launch.errors.locations import SourceLocation, error_at
from linkwright.launch.moveit.configs import MoveItConfigs, Parameters
from linkwright.launch.moveit.files import (
    ParameterBuilderFileNotFoundError,
    ParameterValueType,
    Xacro,
    load_file,
    load_xacro,
    load_yaml,
)
from linkwright.packages import current_finder

if TYPE_CHECKING:
    from typing_extensions import Self

_CONFIG_FOLDER = Path("config")
_CONTROLLERS_SUFFIX = "_controllers.yaml"
_PLANNING_SUFFIX = "_planning.yaml"
_DEFAULT_PIPELINE = "ompl"
_Mappings = Mapping[Any, Any] | None
_Path = str | Path | None


class ParameterBuilder:
    """A collection of parameters, most of them from the files of a package.

    Each method except `to_dict` returns the builder, so that calls can be chained.

    Args:
        package_name: the package that contains the files; relative paths refer to its share folder.

    Raises:
        PackageNotFoundError: PKG101, there is no such package.
    """

    def __init__(self, package_name: str) -> None:
        self._package_path = current_finder().share(package_name)
        self._parameters: dict[str, Any] = {}

    def yaml(
        self,
        file_path: str | Path,
        parameter_namespace: str | None = None,
        mappings: Mapping[str, Any] | None = None,
    ) -> Self:
        """Add the contents of a YAML file, optionally nested under a name."""
        content = load_yaml(self._package_path / file_path, mappings) or {}
        target = self._parameters.setdefault(parameter_namespace, {}) if parameter_namespace else self._parameters
        target.update(content)
        return self

    def file_parameter(self, parameter_name: str, file_path: str | Path) -> Self:
        """Add a parameter with the text of a file."""
        self._parameters[parameter_name] = load_file(self._package_path / file_path)
        return self

    def xacro_parameter(
        self, parameter_name: str, file_path: str | Path, mappings: Mapping[str, Any] | None = None
    ) -> Self:
        """Add a parameter with the expanded text of a xacro or URDF file."""
        self._parameters[parameter_name] = load_xacro(self._package_path / file_path, mappings)
        return self

    def parameter(self, parameter_name: str, parameter_value: ParameterValueType) -> Self:
        """Add a parameter with a value."""
        self._parameters[parameter_name] = parameter_value
        return self

    def to_dict(self) -> dict[str, Any]:
        """Return the collected parameters."""
        return self._parameters


class MoveItConfigsBuilder(ParameterBuilder):
    """A collection of parameters from the files of a MoveIt configuration package.

    Most methods read a file from the given path, or by default from the usual path in the package.

    Args:
        robot_name: the name of the robot.
        robot_description: the name of the parameter with the URDF, which is also the prefix of some other parameters.
        package_name: the configuration package; by default the name of the robot followed by ``_moveit_config``.

    Raises:
        PackageNotFoundError: PKG101, there is no such package.
    """

    def __init__(
        self, robot_name: str, robot_description: str = "robot_description", package_name: str | None = None
    ) -> None:
        super().__init__(package_name or f"{robot_name}_moveit_config")
        self.__name = robot_name
        self.__description_parameter = robot_description
        self.__moveit_configs = MoveItConfigs(package_path=self._package_path)
        self.__urdf, self.__srdf = self.__find_description_paths()

    def robot_description(self, file_path: _Path = None, mappings: _Mappings = None) -> MoveItConfigsBuilder:
        """Read the URDF, or print a warning if its file does not exist.

        If the parameter is not set, nodes read the URDF from the topic ``/robot_description``.
        """
        path = self.__urdf if file_path is None else self._package_path / file_path
        try:
            model = _expand_description(path, mappings or self.__urdf_arguments)
        except ParameterBuilderFileNotFoundError as error:
            _warn_about_missing_urdf(error)
        else:
            self.__moveit_configs.robot_description = {self.__description_parameter: model}
        return self

    def robot_description_semantic(self, file_path: _Path = None, mappings: _Mappings = None) -> MoveItConfigsBuilder:
        """Read the SRDF, and set the parameter for the semantic robot description."""
        path = self.__srdf if file_path is None else self._package_path / file_path
        self.__moveit_configs.robot_description_semantic = {
            f"{self.__description_parameter}_semantic": _expand_description(path, mappings)
        }
        return self

    def robot_description_kinematics(self, file_path: _Path = None) -> MoveItConfigsBuilder:
        """Read the configuration of the inverse kinematics solvers."""
        self.__moveit_configs.robot_description_kinematics = self.__load_parameters(
            "_kinematics", file_path, "kinematics.yaml"
        )
        return self

    def joint_limits(self, file_path: _Path = None) -> MoveItConfigsBuilder:
        """Read the joint limits, which replace the limits in the URDF."""
        self.__moveit_configs.joint_limits = self.__load_parameters("_planning", file_path, "joint_limits.yaml")
        return self

    def moveit_cpp(self, file_path: _Path = None) -> MoveItConfigsBuilder:
        """Read the parameters of MoveItCpp."""
        self.__moveit_configs.moveit_cpp = load_yaml(self.__resolve_file(file_path, "moveit_cpp.yaml"))
        return self

    def pilz_cartesian_limits(self, file_path: _Path = None) -> MoveItConfigsBuilder:
        """Read Cartesian limits for the Pilz planner."""
        self.__moveit_configs.pilz_cartesian_limits = self.__load_parameters(
            "_planning", file_path, "pilz_cartesian_limits.yaml"
        )
        return self

    def cartesian_limits(self, file_path: _Path = None) -> MoveItConfigsBuilder:
        """Read Cartesian limits for the Pilz planner from ``cartesian_limits.yaml``.

        This method has the former name of `pilz_cartesian_limits`.
        """
        return self.pilz_cartesian_limits(file_path or _CONFIG_FOLDER / "cartesian_limits.yaml")

    def trajectory_execution(
        self, file_path: _Path = None, moveit_manage_controllers: bool = True
    ) -> MoveItConfigsBuilder:
        """Read the configuration of the controllers that execute trajectories.

        By default, the file is ``config/*_controllers.yaml``. If there are several such files, it is the one whose name
        begins with ``moveit``, ``moveit2`` or the name of the robot, in this order.

        Args:
            file_path: the file, relative to the package.
            moveit_manage_controllers: whether MoveIt may load and switch controllers.

        Raises:
            RuntimeError: LAUNCH154, there are several such files, and none has one of these names.
        """
        parameters: Parameters = {"moveit_manage_controllers": moveit_manage_controllers}
        path = self._package_path / file_path if file_path is not None else self.__find_controllers_file()
        if path is not None:
            parameters.update(load_yaml(path) or {})
        self.__moveit_configs.trajectory_execution = parameters
        return self

    def planning_scene_monitor(
        self,
        publish_planning_scene: bool = True,
        publish_geometry_updates: bool = True,
        publish_state_updates: bool = True,
        publish_transforms_updates: bool = True,
        publish_robot_description: bool = False,
        publish_robot_description_semantic: bool = False,
    ) -> MoveItConfigsBuilder:
        """Select the parts of the planning scene that are published."""
        self.__moveit_configs.planning_scene_monitor = {
            "publish_planning_scene": publish_planning_scene,
            "publish_geometry_updates": publish_geometry_updates,
            "publish_state_updates": publish_state_updates,
            "publish_transforms_updates": publish_transforms_updates,
            "publish_robot_description": publish_robot_description,
            "publish_robot_description_semantic": publish_robot_description_semantic,
        }
        return self

    def sensors_3d(self, file_path: _Path = None) -> MoveItConfigsBuilder:
        """Read the configuration of the 3D sensors for the occupancy map, if there are any."""
        path = self.__resolve_file(file_path, "sensors_3d.yaml")
        content = load_yaml(path) if path.exists() else None
        if content and any(content.get("sensors") or ()):
            self.__moveit_configs.sensors_3d = content
        return self

    def planning_pipelines(
        self,
        default_planning_pipeline: str | None = None,
        pipelines: Sequence[str] | None = None,
        load_all: bool = True,
    ) -> MoveItConfigsBuilder:
        """Read the configuration of the planning pipelines.

        Args:
            default_planning_pipeline: the name of the default pipeline; by default ``ompl``, or the first pipeline.
            pipelines: the names of the pipelines; by default the pipelines for which the package has a file.
            load_all: whether the default of `pipelines` includes the pipelines for which MoveIt's package
                ``moveit_configs_utils`` has files, if this package is found.

        Raises:
            RuntimeError: LAUNCH154, the default pipeline is not one of the pipelines.
        """
        folders = [self._package_path / _CONFIG_FOLDER, *_find_default_folders()]
        names = (
            list(pipelines)
            if pipelines is not None
            else _find_stems(folders if load_all else folders[:1], _PLANNING_SUFFIX)
        )
        names = names or [default_planning_pipeline or _DEFAULT_PIPELINE]
        default = default_planning_pipeline or (_DEFAULT_PIPELINE if _DEFAULT_PIPELINE in names else names[0])
        if default not in names:
            names_text = ",".join(names)
            text = f"default_planning_pipeline: `{default}` doesn't name any of the input pipelines `{names_text}`"
            message = phrase(
                "the default planning pipeline '{default}' is not one of the pipelines {names}",
                default=default,
                names=joined(names),
            )
            raise error_at(SourceLocation.of_caller(), "LAUNCH154", message, ros_error=RuntimeError(text))
        parameters: Parameters = {"planning_pipelines": names, "default_planning_pipeline": default}
        for name in names:
            file = next((path for folder in folders if (path := folder / f"{name}{_PLANNING_SUFFIX}").exists()), None)
            parameters[name] = (load_yaml(file) if file else None) or {}
        ompl_defaults = next((path for folder in folders[1:] if (path := folder / "ompl_defaults.yaml").exists()), None)
        if (
            ompl_defaults is not None
            and _DEFAULT_PIPELINE in parameters
            and "planner_configs" not in parameters[_DEFAULT_PIPELINE]
        ):
            parameters[_DEFAULT_PIPELINE].update(load_yaml(ompl_defaults))
        self.__moveit_configs.planning_pipelines = parameters
        return self

    def to_moveit_configs(self) -> MoveItConfigs:
        """Return all parameters, after reading the files that have not been read yet.

        Optional files that do not exist are skipped.
        """
        configs = self.__moveit_configs
        if not configs.robot_description:
            self.robot_description()
        if not configs.robot_description_semantic:
            self.robot_description_semantic()
        if not configs.planning_pipelines:
            self.planning_pipelines()
        if not configs.trajectory_execution:
            self.trajectory_execution()
        if not configs.planning_scene_monitor:
            self.planning_scene_monitor()
        if not configs.sensors_3d:
            self.sensors_3d()
        for parameters, file, read_file in (
            (configs.robot_description_kinematics, "kinematics.yaml", self.robot_description_kinematics),
            (configs.joint_limits, "joint_limits.yaml", self.joint_limits),
            (configs.pilz_cartesian_limits, "pilz_cartesian_limits.yaml", self.pilz_cartesian_limits),
        ):
            if not parameters and self.__resolve_file(None, file).exists():
                read_file()
        return configs

    def to_dict(self, include_moveit_configs: bool = True) -> Parameters:
        """Return the collected parameters.

        By default, they include the parameters of `to_moveit_configs`.
        """
        if include_moveit_configs:
            self._parameters.update(self.to_moveit_configs().to_dict())
        return self._parameters

    # --- locations of files -----------------------------------------------------------------------------------

    def __resolve_file(self, file_path: _Path, default_name: str) -> Path:
        return self._package_path / (_CONFIG_FOLDER / default_name if file_path is None else file_path)

    def __load_parameters(self, suffix: str, file_path: _Path, default_name: str) -> Parameters:
        return {self.__description_parameter + suffix: load_yaml(self.__resolve_file(file_path, default_name))}

    def __find_description_paths(self) -> tuple[Path, Path]:
        """Return the paths of the URDF and the SRDF, and store the xacro arguments of the URDF.

        The paths come from the file of MoveIt's Setup Assistant, or are derived from the name of the robot.
        """
        settings = self._package_path / ".setup_assistant"
        recorded_settings = (
            (load_yaml(settings) or {}).get("moveit_setup_assistant_config", {}) if settings.exists() else {}
        )
        urdf_settings, srdf_settings = (
            recorded_settings.get(description_kind) or recorded_settings.get(description_kind.upper()) or {}
            for description_kind in ("urdf", "srdf")
        )
        urdf = self._package_path / _CONFIG_FOLDER / f"{self.__name}.urdf.xacro"
        if not urdf.exists():
            urdf = self._package_path / _CONFIG_FOLDER / f"{self.__name}.urdf"
            if urdf_settings.get("package") and urdf_settings.get("relative_path"):
                urdf = current_finder().share(urdf_settings["package"]) / urdf_settings["relative_path"]
        argument_parts = (argument.partition(":=") for argument in str(urdf_settings.get("xacro_args") or "").split())
        self.__urdf_arguments = {name: value for name, is_pair, value in argument_parts if is_pair}
        srdf = self._package_path / srdf_settings.get("relative_path", _CONFIG_FOLDER / f"{self.__name}.srdf")
        return urdf, srdf

    def __find_controllers_file(self) -> Path | None:
        folder = self._package_path / _CONFIG_FOLDER
        names = _find_stems([folder], _CONTROLLERS_SUFFIX)
        if len(names) > 1:
            names = [name for name in ("moveit", "moveit2", self.__name) if name in names] or names
            if names[0] not in ("moveit", "moveit2", self.__name):
                names_text = "\n - ".join(name + _CONTROLLERS_SUFFIX for name in names)
                text = f"trajectory_execution: Unable to guess which parameter file to load. Options:\n - {names_text}"
                message = phrase(
                    "folder '{folder}' has several controller files: {names}",
                    folder=display_path(folder),
                    names=joined(names),
                )
                hint = phrase("select one with .trajectory_execution(file_path='config/NAME_controllers.yaml')")
                raise error_at(SourceLocation.of_caller(), "LAUNCH154", message, hint, ros_error=RuntimeError(text))
        return folder / (names[0] + _CONTROLLERS_SUFFIX) if names else None


def _warn_about_missing_urdf(error: LookupError) -> None:
    message = phrase("MoveIt's parameters contain no URDF, so nodes read it from the topic /robot_description")
    for diagnostic in getattr(error, "diagnostics", ()):
        warning = diagnostic.with_changes(severity=Severity.WARNING, notes=(*diagnostic.notes, Note(message)))
        print_diagnostics([warning], sys.stderr)


def _expand_description(path: Path, mappings: _Mappings) -> Any:
    """Return the expanded text of a robot description.

    If its arguments contain substitutions, return a parameter value that is expanded during the launch.
    """
    if all(isinstance(text, str) for pair in (mappings or {}).items() for text in pair):
        return load_xacro(path, mappings)
    from linkwright.launch.ros import ParameterValue

    return ParameterValue(Xacro(str(path), mappings=mappings), value_type=str)


def _find_stems(folders: Sequence[Path], suffix: str) -> list[str]:
    """Return the stems of the files with a suffix in some folders, without duplicates."""
    stems = (path.name.removesuffix(suffix) for folder in folders for path in sorted(folder.glob(f"*{suffix}")))
    return list(dict.fromkeys(stems))


def _find_default_folders() -> list[Path]:
    share = current_finder().find("moveit_configs_utils")
    return [] if share is None else [share / "default_configs"]
