import { h } from "../../dom";
import { computeLineStates, tokenize, type LineState } from "../../state/xml-tokens";
import { strings } from "../../strings";
import { VirtualRows } from "../../widgets/virtual-rows";

const ROW_HEIGHT_PX = 18;
/**
 * The maximum number of characters of a line; longer ones are cut, because some files are a single line of a megabyte.
 */
const MAX_LINE_LENGTH = 4000;

/** The lines `firstLine` to `lastLine`, 1-based and inclusive, and how they are marked. */
export interface Highlight {
  readonly firstLine: number;
  readonly lastLine: number;
  readonly kind: "focus" | "problem";
}

/** A text with line numbers and syntax colors; only the visible lines are drawn. */
export class SourceView {
  readonly element: HTMLElement;
  private readonly rows = new VirtualRows("source-lines", ROW_HEIGHT_PX, (index) => this.createRow(index));
  private lines: readonly string[] = [];
  private states: readonly LineState[] = [];
  private highlights: readonly Highlight[] = [];
  private cursor = 1;
  private text: string | null = null;

  /** @param onLineChosen - called with the line that the user clicked, or pressed Enter on. */
  constructor(
    label: string,
    private readonly onLineChosen: (line: number) => void,
  ) {
    this.element = this.rows.element;
    this.element.setAttribute("role", "region");
    this.element.setAttribute("aria-label", label);
    this.element.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.element.addEventListener("click", (event) => this.onClick(event));
  }

  get lineCount(): number {
    return this.lines.length;
  }

  get highlighted(): readonly Highlight[] {
    return this.highlights;
  }

  /** Shows a text; does nothing if it is shown already. */
  setText(text: string): void {
    if (text === this.text) return;
    this.text = text;
    this.lines = text.replace(/\n$/, "").split(/\r\n?|\n/);
    this.states = computeLineStates(this.lines);
    const maxLength = this.lines.reduce((maximum, line) => Math.max(maximum, line.length), 0);
    this.rows.body.style.minWidth = `calc(${Math.min(maxLength, MAX_LINE_LENGTH) + 4}ch + 70px)`;
    this.rows.element.style.setProperty("--gutter", `${String(this.lines.length).length + 1}ch`);
    this.rows.refresh(this.lines.length);
  }

  setHighlights(highlights: readonly Highlight[]): void {
    if (JSON.stringify(highlights) === JSON.stringify(this.highlights)) return;
    this.highlights = highlights;
    this.rows.refresh();
  }

  /** Scrolls to a line and moves the cursor there. */
  reveal(line: number): void {
    this.cursor = line;
    this.rows.reveal(line - 1);
  }

  private createRow(index: number): HTMLElement {
    const line = this.lines[index] ?? "";
    const code = h("code", { class: "source-code" });
    const { tokens } = tokenize(line.slice(0, MAX_LINE_LENGTH), this.states[index] ?? "text");
    for (const { kind, text } of tokens) code.append(kind === "text" ? text : h("span", { class: `xml-${kind}` }, text));
    if (line.length > MAX_LINE_LENGTH) code.append(h("i", {}, strings.description.source.long(line.length - MAX_LINE_LENGTH)));
    const number = index + 1;
    const row = h(
      "div",
      { class: "source-line", data: { line: String(number) } },
      h("span", { class: "source-number" }, String(number)),
      code,
    );
    for (const { firstLine, lastLine, kind } of this.highlights) if (firstLine <= number && number <= lastLine) row.classList.add(kind);
    return row;
  }

  private onClick(event: MouseEvent): void {
    if (!window.getSelection()?.isCollapsed) return; // text is being selected
    const row = (event.target as HTMLElement).closest<HTMLElement>(".source-line");
    if (row) this.chooseLine(Number(row.dataset["line"]));
  }

  private onKeyDown(event: KeyboardEvent): void {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step !== undefined && !event.ctrlKey && !event.metaKey) {
      this.cursor = Math.min(Math.max(1, this.cursor + step), this.lines.length);
      this.rows.reveal(this.cursor - 1);
      this.showCursor();
    } else if (event.key === "Enter") this.chooseLine(this.cursor);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private chooseLine(line: number): void {
    this.cursor = line;
    this.showCursor();
    this.onLineChosen(line);
  }

  private showCursor(): void {
    for (const lineElement of this.element.querySelectorAll(".source-line.cursor")) lineElement.classList.remove("cursor");
    this.rows.rowAt(this.cursor - 1)?.classList.add("cursor");
  }
}
