import type { Connection } from "../connection/connection";
import type { ProgramPage, TerminalItem, TerminalOutput } from "../protocol";
import { Signal } from "../signal";

/** The size of a terminal in characters. */
export interface TerminalSize {
  readonly columns: number;
  readonly rows: number;
}

/** The length of a message with input, so that none is too long for the server. */
const MAX_INPUT_LENGTH = 32 * 1024;

/** The terminals of the program, and the page's requests. */
export class TerminalsState {
  /** The terminals, or the reason of a refusal, have changed. */
  readonly changed = new Signal();
  /** The program has got its first terminal, or lost its last one. */
  readonly availabilityChanged = new Signal();
  /**
   * The connection is new, so that earlier requests get no answers; emitted with whether the program is the same run.
   */
  readonly connected = new Signal<boolean>();
  /** The connection was lost or is back. */
  readonly connectionChanged = new Signal();
  readonly output = new Signal<TerminalOutput>();
  /** Emitted with the number of a terminal whose program does not read its input. */
  readonly inputLost = new Signal<number>();
  /** Emitted when the pages of programs have changed, with whether one is new. */
  readonly programsChanged = new Signal<boolean>();
  /** The folder in which shells start. */
  folder = "";
  items: readonly TerminalItem[] = [];
  /** The pages of the programs in terminals, oldest first. */
  programs: readonly ProgramPage[] = [];
  /** Why the last request was refused, or empty. */
  unavailableReason = "";
  private isAvailableNow = false;
  /** Whether the connection is new, and the server has not reported terminals yet. */
  private isListUnknown = true;
  /** The run of the program. */
  private run = "";
  /** The terminals that this page showed in the same run when the connection was lost. */
  private previouslyShown: ReadonlySet<number> = new Set();

  constructor(private readonly connection: Connection) {
    connection.on("hello", ({ run }) => this.onHello(run));
    connection.on("terminals", ({ folder, terminals, refusal_reason: unavailableReason }) => {
      if (this.isListUnknown && folder !== "") connection.send({ type: "watch_program_pages" });
      [this.folder, this.items, this.unavailableReason] = [folder, this.isListUnknown ? this.ignoreLostConnection(terminals) : terminals, unavailableReason];
      this.isListUnknown = false;
      this.setAvailable(folder !== "");
      this.changed.emit();
    });
    // The last message to a page that opens: a program without terminals has sent no `terminals` before it.
    connection.on("frame_table", () => {
      if (this.isListUnknown) this.setAvailable(false);
      this.isListUnknown = false;
    });
    connection.on("program_pages", ({ pages }) => this.setPrograms(pages));
    connection.stateChanged.on(() => this.connectionChanged.emit());
    connection.on("terminal_output", (message) => this.output.emit(message));
    connection.on("terminal_input_lost", ({ terminal }) => this.inputLost.emit(terminal));
  }

  /** Whether the program was started with terminals in the page. */
  get isAvailable(): boolean {
    return this.isAvailableNow;
  }

  get isConnected(): boolean {
    return this.connection.state === "connected";
  }

  find(id: number): TerminalItem | undefined {
    return this.items.find((item) => item.id === id);
  }

  /** Starts a shell in a new terminal, which this page then shows. */
  open(size: TerminalSize): void {
    this.connection.send({ type: "open_terminal", ...size });
  }

  /** Shows a terminal in this page; its last output arrives first. */
  show(terminal: number, size: TerminalSize): void {
    this.connection.send({ type: "show_terminal", terminal, ...size });
  }

  hide(terminal: number): void {
    this.connection.send({ type: "hide_terminal", terminal });
  }

  /** Sends input: a text, or bytes as the characters of a string. */
  write(terminal: number, text: string, isBinary = false): void {
    for (const part of splitText(text, MAX_INPUT_LENGTH)) {
      this.connection.send({ type: "write_terminal", terminal, text: part, is_binary: isBinary });
    }
  }

  resize(terminal: number, size: TerminalSize): void {
    this.connection.send({ type: "resize_terminal", terminal, ...size });
  }

  acknowledge(terminal: number, number: number): void {
    this.connection.send({ type: "acknowledge_terminal", terminal, number });
  }

  restart(terminal: number, size: TerminalSize): void {
    this.connection.send({ type: "restart_terminal", terminal, ...size });
  }

  close(terminal: number): void {
    this.connection.send({ type: "close_terminal", terminal });
  }

  private onHello(run: string): void {
    this.isListUnknown = true;
    const isSameRun = run === this.run;
    this.previouslyShown = new Set(isSameRun ? this.items.filter(({ shown }) => shown === "here").map(({ id }) => id) : []);
    this.run = run;
    this.connected.emit(isSameRun);
  }

  /**
   * Returns terminals where the lost connection does not count as another page; the program may not know of the loss.
   */
  private ignoreLostConnection(items: readonly TerminalItem[]): TerminalItem[] {
    return items.map((item) => (item.shown === "elsewhere" && this.previouslyShown.has(item.id) ? { ...item, shown: "nowhere" } : item));
  }

  private setPrograms(pages: readonly ProgramPage[]): void {
    const programKeys = this.programs.map(({ id, url }) => `${id} ${url}`);
    this.programs = pages;
    this.programsChanged.emit(pages.some(({ id, url }) => !programKeys.includes(`${id} ${url}`)));
  }

  private setAvailable(isAvailable: boolean): void {
    if (isAvailable === this.isAvailableNow) return;
    this.isAvailableNow = isAvailable;
    if (!isAvailable) this.setPrograms([]);
    this.availabilityChanged.emit();
  }
}

/** Divides a text into parts of at most `length`, without dividing a character of two UTF-16 units. */
export function splitText(text: string, length: number): string[] {
  const parts: string[] = [];
  for (let start = 0; start < text.length; ) {
    let end = Math.min(start + length, text.length);
    if (end < text.length && isHighSurrogate(text.charCodeAt(end - 1))) end -= 1;
    parts.push(text.slice(start, end));
    start = end;
  }
  return parts;
}

function isHighSurrogate(unit: number): boolean {
  return unit >= 0xd800 && unit < 0xdc00;
}
