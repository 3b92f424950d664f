/** The robot descriptions, whose names no other program uses. */
export const DESCRIPTION_PATTERN = "**/{*.xacro,*.urdf,*.sdf,*.world,*.srdf}";

/** The files whose names other programs use, too: they start the server only in a workspace with a ROS package. */
export const PACKAGE_PATTERN =
  "**/{*.launch,*launch.xml,package.xml,model.config,*launch.py,launch/*.py,setup.py,*.yaml,*.yml,*.rviz," +
  "*.msg,*.srv,*.action,CMakeLists.txt}";

/** The documents that start the language server in any workspace. */
export const DESCRIPTION_DOCUMENTS = [
  { scheme: "file", language: "xacro" },
  { scheme: "file", language: "urdf" },
  { scheme: "file", language: "sdf" },
  { scheme: "file", pattern: DESCRIPTION_PATTERN },
];

/** The documents that VS Code sends to the language server, whatever language VS Code gives them. */
export const DOCUMENTS = [...DESCRIPTION_DOCUMENTS, { scheme: "file", pattern: PACKAGE_PATTERN }];

/** The files whose changes on the disk can change diagnostics: descriptions, files that use them, packages and settings. */
export const WATCHED_PATTERN =
  "**/{*.xacro,*.urdf,*.sdf,*.world,*.srdf,*.launch,*.xml,*.py,*.yaml,*.yml,*.toml,*.msg,*.srv,*.action," +
  "model.config,CMakeLists.txt}";

/** The manifests of packages. */
export const MANIFEST_PATTERN = "**/package.xml";

/**
 * Return whether the text of a `package.xml` is the manifest of a ROS package (REP 127, 140 and 149).
 *
 * PEAR and Salesforce packages also have a file with this name, with another root element.
 */
export function isRosManifest(text: string): boolean {
  return /<package(\s+format\s*=\s*["'][123]["'])?\s*>/.test(text);
}
