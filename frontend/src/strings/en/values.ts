/** The names shown for property values, by the values in RViz's files. */
export const values: Readonly<Record<string, string>> = {};
