/** A key with its modifiers: `mod` is Ctrl, or Command on a Mac. */
export interface Shortcut {
  key: string;
  mod?: boolean;
  shift?: boolean;
  alt?: boolean;
}

const userAgent = (globalThis as { navigator?: Navigator }).navigator?.userAgent ?? "";
const IS_MAC = /Macintosh|iPhone|iPad/.test(userAgent);

/** Returns whether an event matches a shortcut. */
export function matchesShortcut(event: KeyboardEvent, { key, mod = false, shift = false, alt = false }: Shortcut): boolean {
  const isModHeld = IS_MAC ? event.metaKey && !event.ctrlKey : event.ctrlKey && !event.metaKey;
  const hasNoModifier = !event.ctrlKey && !event.metaKey;
  // With Alt, some keyboards produce another letter: compare the position of the key.
  const isSameKey = event.key.toLowerCase() === key.toLowerCase() || (alt && event.code === `Key${key.toUpperCase()}`);
  return isSameKey && (mod ? isModHeld : hasNoModifier) && event.shiftKey === shift && event.altKey === alt;
}

const KEY_LABELS: Readonly<Record<string, string>> = { Delete: "Del", Insert: "Ins", ArrowUp: "↑", ArrowDown: "↓" };

/** Returns the keys as labeled on the keyboard: `Ctrl+Shift+S`. */
export function formatShortcut({ key, mod = false, shift = false, alt = false }: Shortcut): string {
  const name = KEY_LABELS[key] ?? key.toUpperCase();
  if (IS_MAC) return `${alt ? "⌥" : ""}${shift ? "⇧" : ""}${mod ? "⌘" : ""}${name}`;
  return [...(mod ? ["Ctrl"] : []), ...(alt ? ["Alt"] : []), ...(shift ? ["Shift"] : []), name].join("+");
}

/** RViz's keys; different keys where the browser uses RViz's itself. */
export const SHORTCUTS = {
  open: { key: "o", mod: true },
  save: { key: "s", mod: true },
  saveAs: { key: "s", mod: true, shift: true },
  undo: { key: "z", mod: true },
  redo: { key: "z", mod: true, shift: true },
  redoToo: { key: "y", mod: true },
  add: { key: "a", alt: true },
  addToo: { key: "Insert" },
  duplicate: { key: "d", alt: true },
  rename: { key: "F2" },
  remove: { key: "Delete" },
  moveUp: { key: "ArrowUp", alt: true },
  moveDown: { key: "ArrowDown", alt: true },
  previousStep: { key: "PageUp", alt: true },
  nextStep: { key: "PageDown", alt: true },
  checkStep: { key: "Enter", alt: true },
} as const satisfies Readonly<Record<string, Shortcut>>;
