/** Texts of the Terminal panel. */
export const terminal = {
  panel: "Terminal",
  off: "The terminal is off. Start the program with --terminal to use your shell here.",
  loading: "Loading the terminal…",
  failed: "The terminal could not be loaded.",
  tabs: "Terminals",
  name: (id: number): string => `Terminal ${id}`,
  input: (id: number): string => `Terminal ${id}. Ctrl+Shift+M leaves the terminal.`,
  keys: "Ctrl+Shift+C copies, Ctrl+Shift+V pastes, Ctrl+Shift+M leaves the terminal",
  new: "New",
  newHint: "Start your shell in another terminal",
  close: "Close",
  closeHint: "End the programs in this terminal, and remove it",
  copyHint: "Copy the selected text (Ctrl+Shift+C)",
  readerHint: "Let a screen reader read the terminal",
  ended: (name: string): string => `${name} (ended)`,
  endedWith: (status: number): string =>
    status < 0 ? `The shell was ended by signal ${-status}.` : `The shell has ended with exit status ${status}.`,
  restart: "Start again",
  elsewhere: "This terminal is shown in another page.",
  showHere: "Show it here",
  inputLost: "The program in this terminal does not read its input, and part of the input was discarded.",
};
