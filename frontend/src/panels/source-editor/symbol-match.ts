/** Whether a name contains the characters of a query in their order; case is ignored. */
export function matchesQuery(query: string, name: string): boolean {
  const characters = name.toLowerCase();
  let index = 0;
  for (const character of query.toLowerCase()) {
    index = characters.indexOf(character, index) + 1;
    if (index === 0) return false;
  }
  return true;
}
