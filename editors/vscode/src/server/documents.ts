/** The names of files that belong to a robot in any workspace. */
export const DESCRIPTIONS = "**/{*.xacro,*.urdf,*.sdf,*.world,*.srdf}";

/** The names of files that other programs use, too: they are read in workspaces with a ROS package. */
export const OF_PACKAGES =
  "**/{*.launch,*launch.xml,package.xml,model.config,*launch.py,launch/*.py,setup.py,*.yaml,*.yml,*.rviz," +
  "*.msg,*.srv,*.action,CMakeLists.txt}";

/** The documents that start the language server. */
export const OF_ROBOTS = [
  { scheme: "file", language: "xacro" },
  { scheme: "file", language: "urdf" },
  { scheme: "file", language: "sdf" },
  { scheme: "file", pattern: DESCRIPTIONS },
];

/** The documents that VS Code sends to the language server, whatever language VS Code gives them. */
export const DOCUMENTS = [...OF_ROBOTS, { scheme: "file", pattern: OF_PACKAGES }];

/** The files whose changes on the disk change findings: descriptions, what calls them, packages and settings. */
export const WATCHED =
  "**/{*.xacro,*.urdf,*.sdf,*.world,*.srdf,*.launch,*.xml,*.py,*.yaml,*.yml,*.toml,*.msg,*.srv,*.action," +
  "model.config,CMakeLists.txt}";

/** The pattern of the manifests of packages. */
export const MANIFESTS = "**/package.xml";

/**
 * Return whether the text of a `package.xml` is the manifest of a ROS package (REP 127, 140 and 149).
 *
 * Packages of PEAR and Salesforce have files with this name and other roots.
 */
export function isRosManifest(text: string): boolean {
  return /<package(\s+format\s*=\s*["'][123]["'])?\s*>/.test(text);
}
