/** Returns the name of a file without its folders. */
export function fileNameOf(path: string): string {
  return path.slice(Math.max(path.lastIndexOf("/"), path.lastIndexOf("\\")) + 1);
}

/** Returns at most the last `parts` parts of a path, which are enough to distinguish files. */
export function shortenPath(path: string, parts = 3): string {
  const names = path.split(/[\\/]/).filter((part) => part !== "");
  return names.length <= parts ? path : `…/${names.slice(-parts).join("/")}`;
}

/** Returns the end of a place, preceded by the commit of its file as git writes it: `HEAD:…/urdf/arm.urdf:3:1`. */
export function shortenPlace(text: string): string {
  const commit = /^[^/\\:]{2,}:(?=[^:]*[/\\])/.exec(text)?.[0] ?? "";
  return commit + shortenPath(text.slice(commit.length), 2);
}

/** Returns `file:line:column`, without the parts that are unknown. */
export function formatPlace(file: string | null, line: number | null, column: number | null): string {
  return [file, line, column].filter((part) => part !== null).join(":");
}
