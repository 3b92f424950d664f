import { button, h } from "../dom";
import { icon, LEVEL_ICONS } from "../icons";
import type { DiagnosticItem, DiagnosticNote } from "../protocol";
import type { Session } from "../state/session";
import { strings } from "../strings";
import type { Panel } from "./panel";
import { placeText, shortPath } from "./place";

/** What is wrong with the description, with the lines it is about. */
export class DiagnosticsPanel implements Panel {
  readonly id = "diagnostics";
  readonly icon = "warn";
  readonly element = h("div", { class: "panel diagnostics" });

  constructor(private readonly session: Session) {
    this.element.setAttribute("aria-live", "polite");
    session.diagnosticsChanged.on(() => this.show());
    this.show();
  }

  private show(): void {
    const { diagnostics } = this.session;
    if (diagnostics.length === 0) {
      this.element.replaceChildren(
        h("p", { class: "empty" }, icon("check", "level-ok"), strings.diagnostics.none),
      );
      return;
    }
    const show = (file: string, line: number): void => this.session.description.placeAsked.emit({ file, line });
    this.element.replaceChildren(...diagnostics.map((item) => card(item, show)));
  }
}

type Show = (file: string, line: number) => void;

function card(item: DiagnosticItem, show: Show): HTMLElement {
  const notes = item.notes.map((note) => {
    return h(
      "li",
      {},
      h("span", { class: "tag" }, strings.diagnostics.note),
      note.message,
      placeButton(note, show),
    );
  });
  const hints = item.hints.map((hint) =>
    h("li", { class: "hint-line" }, h("span", { class: "tag" }, strings.diagnostics.hint), hint),
  );
  return h(
    "article",
    { class: `diagnostic ${item.severity}` },
    h(
      "header",
      {},
      icon(LEVEL_ICONS[item.severity], `level-${item.severity}`),
      h("strong", {}, item.message),
      h("code", { class: "code" }, item.code),
    ),
    placeButton(item, show),
    excerpt(item),
    notes.length + hints.length > 0 ? h("ul", {}, ...notes, ...hints) : null,
  );
}

/** A place that is shown in the Source panel when it is clicked. */
function placeButton({ file, line, column }: Pick<DiagnosticNote, "file" | "line" | "column">, show: Show): HTMLElement | null {
  if (file === null) return null;
  const text = placeText(shortPath(file), line, column);
  return button(placeText(file, line, column), () => show(file, line ?? 1), "place", icon("file"), text);
}

/** The source line with the part in question marked. */
function excerpt(item: DiagnosticItem): HTMLElement | null {
  if (item.excerpt === "") return null;
  const text = item.excerpt.trimStart();
  const indent = item.excerpt.length - text.length;
  const offset = (column: number): number => Math.min(Math.max(0, column - 1 - indent), text.length);
  const start = offset(item.column ?? 1);
  const sameLine = item.end_line === null || item.end_line === item.line;
  const end = sameLine && item.end_column !== null ? offset(item.end_column) : text.length;
  const code = h("code", {}, text.slice(0, start));
  code.append(h("mark", {}, text.slice(start, Math.max(end, start + 1))), text.slice(Math.max(end, start + 1)));
  return h("pre", { class: "excerpt" }, h("span", { class: "line-number" }, String(item.line ?? "")), code);
}
