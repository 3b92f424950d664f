const ADDRESS = /https?:\/\/\S+/;

/** Return the page's address in a line that `linkwright view` prints; undefined if there is none. */
export function addressIn(line: string): string | undefined {
  return ADDRESS.exec(line)?.[0];
}

/** Return a line without the token of the address: VS Code writes its output to files. */
export function withoutToken(line: string): string {
  return line.replace(/([?&]token=)[\w-]+/, "$1...");
}
