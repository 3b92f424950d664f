import { button, coalesced, h } from "../../dom";
import { icon } from "../../icons";
import type { CallSite, SourceRange } from "../../protocol";
import { EXPANDED, type DescriptionModel } from "../../state/description-model";
import { same } from "../../state/element-focus";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { holdWhileSeen } from "../../widgets/when-seen";
import type { Panel } from "../panel";
import { placeText, shortPath, shortPlace } from "../place";
import { currentModel } from "./current-model";
import { SourceView, type Highlight } from "./source-view";

/** A place to show that is not the place of an element, such as that of a diagnostic or macro call. */
interface Spot {
  readonly file: string;
  readonly line: number;
  readonly look: Highlight["look"];
  /** The display whose description the file belongs to, if that is not the one that the panels show. */
  readonly display: string | undefined;
  /** The file's name for users, if that is not its path: a file of a commit, for example. */
  readonly name: string | undefined;
}

/** The files of the description, and next to them the expanded text. The selected link or joint is marked in both. */
export class SourcePanel implements Panel {
  readonly id = "source";
  readonly icon = "code";
  readonly element: HTMLElement;
  private readonly expanded = new SourceView(strings.description.source.expanded, (line) => this.choose(EXPANDED, line));
  private readonly origin = new SourceView(strings.description.source.origin, (line) => this.choose(this.file, line));
  private readonly files = h("select", { class: "choice source-file" });
  private readonly trail = h("div", { class: "source-trail" });
  private readonly notice = h("p", { class: "empty" });
  private readonly empty = h("p", { class: "empty" }, strings.description.waiting);
  private readonly panes: HTMLElement;
  /** The file shown. */
  private file = "";
  private spot: Spot | null = null;
  private model: DescriptionModel | undefined;
  private visible = false;
  /** The lines to scroll to once their text has arrived. */
  private wanted: { expanded: number | null; origin: number | null } = { expanded: null, origin: null };

  constructor(private readonly session: Session) {
    const words = strings.description.source;
    this.files.setAttribute("aria-label", words.file);
    this.files.addEventListener("change", () => this.openFile(this.files.value));
    const heading = (text: string, title: string, ...more: HTMLElement[]): HTMLElement =>
      h("div", { class: "source-heading" }, h("span", { class: "toolbar-label", title }, text), ...more);
    this.panes = h(
      "div",
      { class: "source-panes" },
      h(
        "section",
        { class: "source-pane" },
        heading(words.origin, words.file, this.files),
        this.trail,
        this.notice,
        this.origin.element,
      ),
      h("section", { class: "source-pane" }, heading(words.expanded, words.expandedHint), this.expanded.element),
    );
    this.element = h("div", { class: "panel source-panel" }, this.empty, this.panes);
    const { description, focus } = session;
    const update = coalesced(() => this.update());
    holdWhileSeen(
      this.element,
      () => {
        this.visible = true;
        const release = description.hold();
        return () => {
          this.visible = false;
          release();
        };
      },
      () => this.renewed(),
    );
    description.arrived.on(coalesced(() => this.renewed()));
    description.textArrived.on(update);
    description.textsOutdated.on(update);
    focus.changed.on(coalesced(() => this.focused()));
    this.update();
  }

  /** Shows a line of a file, such as a diagnostic's. */
  reveal(file: string, line: number, { look = "problem", display, name }: Partial<Pick<Spot, "look" | "display" | "name">> = {}): void {
    this.spot = { file, line, look: display === undefined ? look : "focus", display, name };
    this.file = file;
    this.wanted.origin = line;
    this.update();
  }

  /** Returns what is shown and marked, for tests. */
  inspect(): object {
    const marks = (view: SourceView): object => view.highlighted.map(({ from, to, look }) => ({ from, to, look }));
    return {
      expanded: { lines: this.expanded.lineCount, marks: marks(this.expanded) },
      origin: { file: this.file, lines: this.origin.lineCount, marks: marks(this.origin) },
    };
  }

  /** Follows the selection, or a new place of the selected element. */
  private focused(): void {
    this.model = currentModel(this.session);
    const { expanded, origin } = this.places();
    if (expanded) this.wanted.expanded = expanded.line;
    if (origin) {
      this.spot = null;
      this.file = origin.file;
      this.wanted.origin = origin.line;
    }
    this.update();
  }

  /**
   * Updates when the panel becomes visible or the description changes. A place that was asked for stays until the
   * selection changes.
   */
  private renewed(): void {
    if (this.spot === null || this.spot.file !== this.file) this.focused();
    else this.update();
  }

  private update(): void {
    this.model = currentModel(this.session);
    const { model } = this;
    const faulty = this.session.diagnostics.flatMap((item) => (item.file === null ? [] : [item.file]));
    const files = [...new Set([...(model?.description.files ?? []), ...faulty, ...(this.spot ? [this.spot.file] : [])])];
    this.empty.hidden = model !== undefined || files.length > 0;
    this.panes.hidden = !this.empty.hidden;
    if (!files.includes(this.file)) this.file = files[0] ?? "";
    this.listFiles(files);
    if (!this.visible) return;
    this.show();
  }

  private show(): void {
    const display = this.model?.display ?? "";
    const { expanded, origin } = this.places();
    const words = strings.description.source;
    if (this.model) this.fill(this.expanded, this.session.description.text(display, EXPANDED), marks(expanded), "expanded");
    const text = this.file === "" ? null : this.session.description.text(this.spot?.file === this.file ? (this.spot.display ?? display) : display, this.file);
    const marked = origin?.file === this.file ? marks(origin) : [];
    if (this.spot?.file === this.file) marked.push({ from: this.spot.line, to: this.spot.line, look: this.spot.look });
    this.notice.hidden = typeof text === "string";
    this.origin.element.hidden = text === null;
    if (this.file === "") this.notice.textContent = words.noOrigin;
    else this.notice.textContent = text === null ? words.gone : words.loading;
    this.fill(this.origin, text, [...marked, ...this.problems()], "origin");
    this.showTrail();
  }

  private fill(view: SourceView, text: string | null | undefined, highlights: Highlight[], pane: "expanded" | "origin"): void {
    if (typeof text !== "string") return; // the old one stays until the new one is here
    view.setText(text);
    view.setHighlights(highlights);
    const line = this.wanted[pane];
    if (line !== null) view.reveal(line);
    this.wanted[pane] = null;
  }

  private places(): { expanded: SourceRange | null; origin: SourceRange | null; calls: readonly CallSite[] } {
    const { current } = this.session.focus;
    const written = current && this.model?.display === current.display ? this.model.written(current) : undefined;
    return written ?? { expanded: null, origin: null, calls: [] };
  }

  /** Returns the findings in the file shown. */
  private problems(): Highlight[] {
    return this.session.diagnostics.flatMap(({ file, line, end_line }) =>
      file === this.file && line !== null ? [{ from: line, to: end_line ?? line, look: "problem" as const }] : [],
    );
  }

  private listFiles(files: readonly string[]): void {
    const options = files.map((file) => {
      const name = this.spot?.file === file ? this.spot.name : undefined;
      const option = h("option", { title: name ?? file }, name === undefined ? shortPath(file) : shortPlace(name));
      option.value = file;
      return option;
    });
    this.files.replaceChildren(...options);
    this.files.value = this.file;
    this.files.title = this.file;
    this.files.hidden = files.length === 0;
  }

  private openFile(file: string): void {
    this.file = file;
    this.wanted.origin = this.places().origin?.file === file ? (this.places().origin?.line ?? 1) : 1;
    this.update();
  }

  /** Shows the macro calls and includes that lead to the element, each as a link to its place. */
  private showTrail(): void {
    const words = strings.description.source;
    const { origin, calls } = this.places();
    const steps = calls.map(({ macro, file, line, column }) => {
      const text = words.call(macro, placeText(shortPath(file, 1), line, null));
      return button(placeText(file, line, column), () => this.reveal(file, line, { look: "focus" }), "trail-step", text);
    });
    const back = origin && this.spot
      ? button(words.origin, () => this.focused(), "tool bare", icon("reset"))
      : null;
    this.trail.hidden = steps.length === 0;
    this.trail.replaceChildren(h("span", { class: "tag" }, words.made), ...steps, ...(back ? [back] : []));
  }

  /**
   * Selects the element written on a line; if a macro makes the line yield several, the one after the selected element.
   */
  private choose(file: string, line: number): void {
    const here = this.model?.elementsAt(file, line) ?? [];
    const at = here.findIndex((element) => same(element, this.session.focus.current));
    const next = here[(at + 1) % here.length];
    if (next) this.session.focus.select(next);
  }
}

function marks(range: SourceRange | null): Highlight[] {
  return range ? [{ from: range.line, to: range.end_line, look: "focus" }] : [];
}
