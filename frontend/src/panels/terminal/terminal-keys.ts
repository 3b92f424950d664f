/** The keys, pressed with Ctrl and Shift, that the page does not pass to the shell, as positions on the keyboard. */
export const TERMINAL_KEYS = { copy: "KeyC", paste: "KeyV", leave: "KeyM" } as const;

/** Returns a key of the terminal as labeled on the keyboard: `Ctrl+Shift+C`. */
export function formatTerminalKey(code: string): string {
  return `Ctrl+Shift+${code.replace("Key", "")}`;
}
