/** Whether a name contains the characters of a query in their order; upper and lower case are equal. */
export function matches(query: string, name: string): boolean {
  const characters = name.toLowerCase();
  let at = 0;
  for (const character of query.toLowerCase()) {
    at = characters.indexOf(character, at) + 1;
    if (at === 0) return false;
  }
  return true;
}
