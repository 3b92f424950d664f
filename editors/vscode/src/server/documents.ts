/** The names of the files that the language server reads, whatever language VS Code gives them. */
export const FILES =
  "**/{*.xacro,*.urdf,*.sdf,*.world,*.srdf,*.launch,*.launch.xml,*.launch.py,*_launch.py,package.xml,CMakeLists.txt,setup.py," +
  "model.config,*.msg,*.srv,*.action,*.yaml,*.yml,*.rviz}";

/** The documents that VS Code sends to the language server. */
export const DOCUMENTS = [
  { scheme: "file", language: "xacro" },
  { scheme: "file", language: "urdf" },
  { scheme: "file", language: "sdf" },
  { scheme: "file", pattern: FILES },
];

/** The files whose changes on the disk change findings: descriptions, what calls them, packages and settings. */
export const WATCHED =
  "**/{*.xacro,*.urdf,*.sdf,*.world,*.srdf,*.launch,*.xml,*.py,*.yaml,*.yml,*.toml,model.config,CMakeLists.txt}";
