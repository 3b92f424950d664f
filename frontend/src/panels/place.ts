/** The end of a path is what tells files apart: at most its last `parts` parts. */
export function shortPath(path: string, parts = 3): string {
  const all = path.split(/[\\/]/).filter((part) => part !== "");
  return all.length <= parts ? path : `…/${all.slice(-parts).join("/")}`;
}

/** The end of a place, and before it the commit that its file is of, as git writes it: `HEAD:…/urdf/arm.urdf:3:1`. */
export function shortPlace(text: string): string {
  const commit = /^[^/\\:]{2,}:(?=[^:]*[/\\])/.exec(text)?.[0] ?? "";
  return commit + shortPath(text.slice(commit.length), 2);
}

/** `file:line:column` with whatever of it is known. */
export function placeText(file: string | null, line: number | null, column: number | null): string {
  return [file, line, column].filter((part) => part !== null).join(":");
}
