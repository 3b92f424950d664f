import type { Places } from "../src/server/candidates.js";

/** Return places without any Linkwright, with the given overrides. */
export function createPlaces(overrides: Partial<Places> = {}): Places {
  return {
    interpreter: "",
    folders: ["/work"],
    home: "/home/me",
    isWindows: false,
    exists: () => false,
    getSelectedPython: () => Promise.resolve(undefined),
    findOnPath: () => undefined,
    ...overrides,
  };
}
