/** The shown names of property values, by RViz's words in the file. */
export const values: Readonly<Record<string, string>> = {};
