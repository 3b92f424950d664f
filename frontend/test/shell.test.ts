import { describe, expect, it } from "vitest";
import { createSocketUrl } from "../src/connection/connection";
import { addressFor, hasOwnDisplays, ensureOwnKey } from "../src/shell/own-displays";
import { chooseSaveTarget } from "../src/shell/file-keys";
import { ThemeState } from "../src/state/theme";
import { formatShortcut, matchesShortcut, SHORTCUTS } from "../src/widgets/shortcuts";

function createStorage(): { getItem(key: string): string | null; setItem(key: string, text: string): void } {
  const texts = new Map<string, string>();
  return { getItem: (key) => texts.get(key) ?? null, setItem: (key, text) => void texts.set(key, text) };
}

describe("own displays of a page", () => {
  it("are requested in the page's address", () => {
    const ownAddress = addressFor("http://localhost:7447/?token=abc", true);
    expect(ownAddress).toBe("http://localhost:7447/?token=abc&displays=own");
    expect(hasOwnDisplays(ownAddress)).toBe(true);
    expect(addressFor(ownAddress, false)).toBe("http://localhost:7447/?token=abc");
    expect(hasOwnDisplays("http://localhost:7447/?displays=shared")).toBe(false);
  });

  it("have a name that is stable for the tab", () => {
    const tab = createStorage();
    const key = ensureOwnKey(tab);
    expect(key).toMatch(/^[0-9a-f]{32}$/);
    expect(ensureOwnKey(tab)).toBe(key);
    expect(ensureOwnKey(createStorage())).not.toBe(key);
    expect(createSocketUrl("http://localhost:7447/?token=abc&displays=own", key)).toBe(
      `ws://localhost:7447/ws?own=${key}`,
    );
  });
});

describe("shortcuts", () => {
  const createEvent = (part: Partial<KeyboardEvent>): KeyboardEvent =>
    ({ key: "", code: "", ctrlKey: false, metaKey: false, shiftKey: false, altKey: false, ...part }) as KeyboardEvent;

  it("match exactly the modifiers that are pressed", () => {
    expect(matchesShortcut(createEvent({ key: "s", ctrlKey: true }), SHORTCUTS.save)).toBe(true);
    expect(matchesShortcut(createEvent({ key: "S", ctrlKey: true, shiftKey: true }), SHORTCUTS.save)).toBe(false);
    expect(matchesShortcut(createEvent({ key: "S", ctrlKey: true, shiftKey: true }), SHORTCUTS.saveAs)).toBe(true);
    expect(matchesShortcut(createEvent({ key: "s" }), SHORTCUTS.save)).toBe(false);
    expect(matchesShortcut(createEvent({ key: "å", code: "KeyA", altKey: true }), SHORTCUTS.add)).toBe(true);
    expect(matchesShortcut(createEvent({ key: "Delete" }), SHORTCUTS.remove)).toBe(true);
    expect(matchesShortcut(createEvent({ key: "Delete", ctrlKey: true }), SHORTCUTS.remove)).toBe(false);
  });

  it("do not include those reserved by browsers", () => {
    const browserShortcuts = ["Ctrl+N", "Ctrl+T", "Ctrl+W", "Ctrl+R", "Ctrl+Shift+N", "Ctrl+Shift+T", "Ctrl+Shift+W", "F5", "Ctrl+D"];
    const shortcuts = Object.values(SHORTCUTS).map(formatShortcut);
    expect(shortcuts.filter((key) => browserShortcuts.includes(key))).toEqual([]);
    expect(new Set(shortcuts).size).toBe(shortcuts.length);
    expect(formatShortcut(SHORTCUTS.moveUp)).toBe("Alt+↑");
  });
});

describe("the theme", () => {
  function createTheme(isLight: boolean, texts = createStorage()): { theme: ThemeState; root: HTMLElement; changeSystemTheme: (isLight: boolean) => void } {
    const listeners: (() => void)[] = [];
    const query = { matches: isLight, addEventListener: (_: string, run: () => void) => listeners.push(run) };
    const root = { dataset: {} } as HTMLElement;
    const theme = new ThemeState(root, texts, query as unknown as MediaQueryList);
    const changeSystemTheme = (isLight: boolean): void => {
      query.matches = isLight;
      for (const run of listeners) run();
    };
    return { theme, root, changeSystemTheme };
  }

  it("follows the system until the user chooses one, which is stored", () => {
    const texts = createStorage();
    const { theme, root, changeSystemTheme } = createTheme(false, texts);
    expect(root.dataset["theme"]).toBe("dark");
    changeSystemTheme(true);
    expect(root.dataset["theme"]).toBe("light");
    theme.choose("dark");
    expect(root.dataset["theme"]).toBe("dark");
    changeSystemTheme(true);
    expect(root.dataset["theme"]).toBe("dark");
    expect(createTheme(true, texts).root.dataset["theme"]).toBe("dark");
  });
});

describe("the key of Save", () => {
  const UNCHANGED = { focus: "elsewhere", isEditing: false, hasUnsavedSources: false, isConfigurationUnsaved: false } as const;

  it("saves the configuration, as in RViz, where no source files are edited", () => {
    expect(chooseSaveTarget(UNCHANGED)).toBe("configuration");
  });

  it("saves changed source files, wherever the focus is but in panels of the configuration", () => {
    const changed = { ...UNCHANGED, isEditing: true, hasUnsavedSources: true, isConfigurationUnsaved: true };
    expect(chooseSaveTarget(changed)).toBe("sources");
    expect(chooseSaveTarget({ ...changed, focus: "configuration" })).toBe("configuration");
    expect(chooseSaveTarget({ ...changed, hasUnsavedSources: false })).toBe("configuration");
    expect(chooseSaveTarget({ ...changed, hasUnsavedSources: false, focus: "editor" })).toBe("sources");
  });

  it("asks for no name of an unchanged configuration while source files are edited", () => {
    expect(chooseSaveTarget({ ...UNCHANGED, isEditing: true })).toBe("sources");
    expect(chooseSaveTarget({ ...UNCHANGED, isEditing: true, focus: "configuration" })).toBe("configuration");
  });
});
