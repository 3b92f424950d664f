import type { Connection } from "../../connection/connection";
import type { LogLine } from "../../protocol";
import { Signal } from "../../signal";

/** The maximum number of records; beyond it, the oldest tenth is dropped. */
export const MAX_RECORDS = 20_000;
const STORAGE_KEY = "linkwright.log-levels";

export const LEVELS = [10, 20, 30, 40, 50] as const;
export type Level = (typeof LEVELS)[number];

/** Returns the level whose color and name a record has: rcl_interfaces/msg/Log permits values in between. */
export function levelOf(line: Pick<LogLine, "level">): Level {
  return LEVELS.findLast((level) => line.level >= level) ?? 10;
}

/** Returns a record as text for copying, in the format of the console. */
export function formatLine(line: LogLine, levelName: string): string {
  const source = line.file === "" ? "" : ` (${line.file}:${line.line})`;
  return `[${levelName}] [${line.time.toFixed(9)}] [${line.node}]: ${line.message}${source}`;
}

/** The records of /rosout that the page has received, and those that pass the filters. */
export class LogState {
  /** Records or filters changed. */
  readonly changed = new Signal();
  lines: LogLine[] = [];
  /** The records that pass the filters. */
  shownLines: LogLine[] = [];
  /** The number of records that the server could not send in time. */
  missedCount = 0;
  readonly levels: Set<number>;
  isPaused = false;
  private node = "";
  private text = "";
  private pendingLines: LogLine[] = [];
  private isOpen = false;
  /**
   * Whether the next records are the first of a connection: the server starts with past records, and the page may
   * already have some of them.
   */
  private isFirstBatch = true;

  constructor(
    private readonly connection: Connection,
    private readonly storage: Pick<Storage, "getItem" | "setItem">,
  ) {
    const savedText = storage.getItem(STORAGE_KEY);
    this.levels = new Set(savedText === null ? LEVELS : savedText.split(",").map(Number));
    connection.on("hello", () => {
      this.isFirstBatch = true;
      if (this.isOpen) this.sendWatch();
    });
    connection.on("log_lines", ({ lines, missed }) => {
      this.missedCount += missed;
      this.add(this.isFirstBatch ? this.filterUnknown(lines) : lines);
      this.isFirstBatch = false;
    });
  }

  /** The nodes that have written records, sorted. */
  get nodes(): string[] {
    return [...new Set(this.lines.map((line) => line.node))].sort();
  }

  setOpen(isOpen: boolean): void {
    if (isOpen === this.isOpen) return;
    this.isOpen = isOpen;
    this.sendWatch();
  }

  setLevel(level: number, isShown: boolean): void {
    if (isShown) this.levels.add(level);
    else this.levels.delete(level);
    this.storage.setItem(STORAGE_KEY, [...this.levels].join(","));
    this.filter();
  }

  setNode(node: string): void {
    this.node = node;
    this.filter();
  }

  setText(text: string): void {
    this.text = text.toLowerCase();
    this.filter();
  }

  /** Pauses or resumes; records that arrive during a pause are shown on resuming. */
  setPaused(isPaused: boolean): void {
    this.isPaused = isPaused;
    const { pendingLines } = this;
    this.pendingLines = [];
    if (!isPaused) this.add(pendingLines);
    this.changed.emit();
  }

  clear(): void {
    this.lines = [];
    this.pendingLines = [];
    this.missedCount = 0;
    this.filter();
  }

  private filterUnknown(lines: readonly LogLine[]): LogLine[] {
    const knownKeys = new Set([...this.lines, ...this.pendingLines].map(createRecordKey));
    return lines.filter((line) => !knownKeys.has(createRecordKey(line)));
  }

  private add(lines: readonly LogLine[]): void {
    if (this.isPaused) {
      this.pendingLines.push(...lines);
      if (this.pendingLines.length > MAX_RECORDS) this.pendingLines = this.pendingLines.slice(-MAX_RECORDS);
      return;
    }
    this.lines.push(...lines);
    if (this.lines.length > MAX_RECORDS) {
      this.lines = this.lines.slice(-MAX_RECORDS * 0.9);
      this.filter();
      return;
    }
    this.shownLines.push(...lines.filter((line) => this.passesFilters(line)));
    this.changed.emit();
  }

  private filter(): void {
    this.shownLines = this.lines.filter((line) => this.passesFilters(line));
    this.changed.emit();
  }

  private passesFilters(line: LogLine): boolean {
    if (!this.levels.has(levelOf(line))) return false;
    if (this.node !== "" && line.node !== this.node) return false;
    return this.text === "" || line.message.toLowerCase().includes(this.text) || line.node.toLowerCase().includes(this.text);
  }

  private sendWatch(): void {
    this.connection.send({ type: "watch_log", watched: this.isOpen });
  }
}

function createRecordKey({ time, node, message }: LogLine): string {
  return JSON.stringify([time, node, message]);
}
