/** The keys that the page keeps from the shell, as positions on the keyboard; each with Ctrl and Shift. */
export const TERMINAL_KEYS = { copy: "KeyC", paste: "KeyV", leave: "KeyM" } as const;

/** Returns a key of the terminal as labeled on the keyboard: `Ctrl+Shift+C`. */
export function terminalKeyText(code: string): string {
  return `Ctrl+Shift+${code.replace("Key", "")}`;
}
