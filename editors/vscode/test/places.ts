import type { Places } from "../src/server/candidates.js";

/** Return places with nothing in them, except what is given. */
export function emptyPlaces(given: Partial<Places> = {}): Places {
  return {
    interpreter: "",
    folders: ["/work"],
    home: "/home/me",
    isWindows: false,
    exists: () => false,
    selectedPython: () => Promise.resolve(undefined),
    onPath: () => undefined,
    ...given,
  };
}
