/** What values of properties are called that a file has in RViz's words. */
export const values: Readonly<Record<string, string>> = {};
