import { createButton, coalesce, h } from "../../dom";
import { createIcon } from "../../icons";
import type { CallSite, SourceRange } from "../../protocol";
import { openBrowserStorage } from "../../storage";
import { EXPANDED_TEXT_KEY, type DescriptionModel, type ElementName } from "../../state/description-model";
import { isSameElement } from "../../state/element-focus";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import { holdWhileVisible } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { EditorPane } from "../source-editor/editor-pane";
import { formatPlace, shortenPath, shortenPlace } from "../place";
import { getCurrentModel } from "./current-model";
import { SourceView, type Highlight } from "./source-view";

/** A place to show that is not the place of an element, such as that of a diagnostic or macro call. */
interface RequestedPlace {
  readonly file: string;
  readonly line: number;
  readonly highlightKind: Highlight["kind"];
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
  private readonly expandedView = new SourceView(strings.description.source.expanded, (line) => this.selectElementAt(EXPANDED_TEXT_KEY, line));
  private readonly originView = new SourceView(strings.description.source.origin, (line) => this.selectElementAt(this.file, line));
  private readonly fileSelect = h("select", { class: "choice source-file" });
  private readonly trail = h("div", { class: "source-trail" });
  private readonly notice = h("p", { class: "empty" });
  private readonly emptyNote = h("p", { class: "empty" }, strings.description.waiting);
  private readonly panes: HTMLElement;
  private readonly editor: EditorPane;
  /** The file shown. */
  private file = "";
  private requestedPlace: RequestedPlace | null = null;
  /** Whether the selection follows the cursor of the editor, which then stays where it is. */
  private followsCursor = false;
  /** The element whose lines were shown last. */
  private focusedElement: ElementName | null = null;
  private model: DescriptionModel | undefined;
  private isVisible = false;
  /** The lines to scroll to once their text has arrived. */
  private pendingReveal: { expanded: number | null; origin: number | null } = { expanded: null, origin: null };

  constructor(private readonly session: Session) {
    const texts = strings.description.source;
    this.fileSelect.setAttribute("aria-label", texts.file);
    this.fileSelect.addEventListener("change", () => this.openFile(this.fileSelect.value));
    const createHeading = (text: string, title: string, ...elements: HTMLElement[]): HTMLElement =>
      h("div", { class: "source-heading" }, h("span", { class: "toolbar-label", title }, text), ...elements);
    this.editor = new EditorPane(session, openBrowserStorage(), (file, line) => this.selectAtCursor(file, line), (file) => {
      this.file = file ?? this.file;
      this.update();
    });
    this.panes = h(
      "div",
      { class: "source-panes" },
      h(
        "section",
        { class: "source-pane" },
        createHeading(texts.origin, texts.file, this.fileSelect, this.editor.toggle),
        this.trail,
        this.editor.notice,
        this.notice,
        this.originView.element,
        this.editor.element,
      ),
      h("section", { class: "source-pane" }, createHeading(texts.expanded, texts.expandedHint), this.expandedView.element),
    );
    this.element = h("div", { class: "panel source-panel" }, this.emptyNote, this.panes);
    const { description, focus } = session;
    const update = coalesce(() => this.update());
    holdWhileVisible(
      this.element,
      () => {
        this.isVisible = true;
        const release = description.hold();
        return () => {
          this.isVisible = false;
          release();
        };
      },
      () => this.refresh(),
    );
    description.arrived.on(coalesce(() => this.refresh()));
    description.textArrived.on(update);
    description.textsOutdated.on(update);
    focus.changed.on(coalesce(() => this.showFocus()));
    this.update();
  }

  /** Shows a line of a file, such as a diagnostic's. */
  reveal(file: string, line: number, { highlightKind = "problem", display, name }: Partial<Pick<RequestedPlace, "highlightKind" | "display" | "name">> = {}): void {
    this.requestedPlace = { file, line, highlightKind: display === undefined ? highlightKind : "focus", display, name };
    this.file = file;
    this.pendingReveal.origin = line;
    this.update();
  }

  /** Opens the editor for the files of a folder, even if no description is shown. */
  openWorkspace(folder: string): void {
    this.element.classList.add("of-workspace");
    this.editor.openWorkspace(folder);
    this.update();
  }

  /** Edits a file, which is created when it is saved if it does not exist. */
  async edit(path: string): Promise<void> {
    this.requestedPlace = null;
    await this.editor.edit(path);
    this.file = path;
    this.update();
  }

  /** Whether the editor shows files. */
  get isEditing(): boolean {
    return this.editor.isShown;
  }

  get hasUnsaved(): boolean {
    return this.editor.hasUnsaved;
  }

  /** Writes all files that have changed. */
  saveAll(): void {
    this.editor.saveAll();
  }

  /** Returns what is shown and marked, for tests. */
  inspect(): object {
    const listMarks = (view: SourceView): object => view.highlighted.map(({ firstLine, lastLine, kind }) => ({ from: firstLine, to: lastLine, look: kind }));
    return {
      editor: this.editor.inspect(),
      expanded: { lines: this.expandedView.lineCount, marks: listMarks(this.expandedView) },
      origin: { file: this.file, lines: this.originView.lineCount, marks: listMarks(this.originView) },
    };
  }

  /** Follows the selection, or a new place of the selected element. */
  private showFocus(): void {
    this.model = getCurrentModel(this.session);
    const { expanded, origin } = this.findWrittenPlaces();
    if (expanded) this.pendingReveal.expanded = expanded.line;
    const { current } = this.session.focus;
    const keepsScroll = this.editor.isShown && (this.followsCursor || isSameElement(current, this.focusedElement));
    this.focusedElement = current;
    if (origin && !keepsScroll) {
      this.requestedPlace = null;
      this.file = origin.file;
      this.pendingReveal.origin = origin.line;
    }
    this.followsCursor = false;
    this.update();
  }

  /**
   * Updates when the panel becomes visible or the description changes. A place that was asked for stays until the
   * selection changes.
   */
  private refresh(): void {
    const keepsScroll = this.editor.isShown || (this.requestedPlace !== null && this.requestedPlace.file === this.file);
    if (keepsScroll) this.update();
    else this.showFocus();
  }

  private update(): void {
    this.model = getCurrentModel(this.session);
    const { model } = this;
    const filesWithFindings = this.session.diagnostics.flatMap((item) => (item.file === null ? [] : [item.file]));
    const files = [...new Set([...(model?.description.files ?? []), ...filesWithFindings, ...this.editor.files, ...(this.requestedPlace ? [this.requestedPlace.file] : [])])];
    this.emptyNote.hidden = model !== undefined || files.length > 0 || this.editor.hasWorkspace;
    this.panes.hidden = !this.emptyNote.hidden;
    if (!files.includes(this.file)) this.file = files[0] ?? "";
    this.updateFileSelect(files);
    if (!this.isVisible) return;
    this.showTexts();
  }

  private showTexts(): void {
    const display = this.model?.display ?? "";
    const { expanded, origin } = this.findWrittenPlaces();
    const texts = strings.description.source;
    if (this.model) this.fillView(this.expandedView, this.session.description.textOf(display, EXPANDED_TEXT_KEY), createFocusHighlights(expanded), "expanded");
    const displayOfFile = this.requestedPlace?.file === this.file ? (this.requestedPlace.display ?? display) : display;
    const text = this.file === "" ? null : this.session.description.textOf(displayOfFile, this.file);
    const originMarks = origin?.file === this.file ? createFocusHighlights(origin) : [];
    if (this.requestedPlace?.file === this.file) {
      const { line, highlightKind } = this.requestedPlace;
      originMarks.push({ firstLine: line, lastLine: line, kind: highlightKind });
    }
    const highlights = [...originMarks, ...this.createProblemMarks()];
    const isWorkingFile = this.file !== "" && (this.requestedPlace?.file !== this.file || (this.requestedPlace.display ?? display) === display);
    const isEdited = this.editor.show(isWorkingFile ? this.file : null, isWorkingFile ? highlights : [], this.pendingReveal.origin);
    if (isEdited) this.pendingReveal.origin = null;
    this.notice.hidden = isEdited || typeof text === "string";
    this.originView.element.hidden = isEdited || text === null;
    if (this.file === "") this.notice.textContent = texts.noOrigin;
    else this.notice.textContent = text === null ? texts.gone : texts.loading;
    if (!isEdited) this.fillView(this.originView, text, highlights, "origin");
    this.showCallTrail();
  }

  private fillView(view: SourceView, text: string | null | undefined, highlights: Highlight[], pane: "expanded" | "origin"): void {
    if (typeof text !== "string") return; // the old text stays until the new one has arrived
    view.setText(text);
    view.setHighlights(highlights);
    const line = this.pendingReveal[pane];
    if (line !== null) view.reveal(line);
    this.pendingReveal[pane] = null;
  }

  private findWrittenPlaces(): { expanded: SourceRange | null; origin: SourceRange | null; calls: readonly CallSite[] } {
    const { current } = this.session.focus;
    const places = current && this.model?.display === current.display ? this.model.sourceOf(current) : undefined;
    return places ?? { expanded: null, origin: null, calls: [] };
  }

  /** Returns the findings in the file shown. */
  private createProblemMarks(): Highlight[] {
    return this.session.diagnostics.flatMap(({ file, line, end_line }) =>
      file === this.file && line !== null ? [{ firstLine: line, lastLine: end_line ?? line, kind: "problem" as const }] : [],
    );
  }

  private updateFileSelect(files: readonly string[]): void {
    const options = files.map((file) => {
      const name = this.requestedPlace?.file === file ? this.requestedPlace.name : undefined;
      const option = h("option", { title: name ?? file }, name === undefined ? shortenPath(file) : shortenPlace(name));
      option.value = file;
      return option;
    });
    this.fileSelect.replaceChildren(...options);
    this.fileSelect.value = this.file;
    this.fileSelect.title = this.file;
    this.fileSelect.hidden = files.length === 0;
  }

  private openFile(file: string): void {
    this.file = file;
    this.pendingReveal.origin = this.findWrittenPlaces().origin?.file === file ? (this.findWrittenPlaces().origin?.line ?? 1) : 1;
    this.update();
  }

  /** Shows the macro calls and includes that lead to the element, each as a link to its place. */
  private showCallTrail(): void {
    const texts = strings.description.source;
    const { origin, calls } = this.findWrittenPlaces();
    const steps = calls.map(({ macro, file, line, column }) => {
      const text = texts.call(macro, formatPlace(shortenPath(file, 1), line, null));
      return createButton(formatPlace(file, line, column), () => this.reveal(file, line, { highlightKind: "focus" }), "trail-step", text);
    });
    const backButton = origin && this.requestedPlace
      ? createButton(texts.origin, () => this.showFocus(), "tool bare", createIcon("reset"))
      : null;
    this.trail.hidden = steps.length === 0;
    this.trail.replaceChildren(h("span", { class: "tag" }, texts.made), ...steps, ...(backButton ? [backButton] : []));
  }

  /** Selects the element written on the line of the cursor, unless one of them is selected. */
  private selectAtCursor(file: string, line: number): void {
    const elements = this.model?.elementsAt(file, line) ?? [];
    if (elements.length === 0 || elements.some((element) => isSameElement(element, this.session.focus.current))) return;
    this.followsCursor = true;
    this.selectElementAt(file, line);
  }

  /**
   * Selects the element written on a line; if a macro makes the line yield several, the one after the selected element.
   */
  private selectElementAt(file: string, line: number): void {
    const elements = this.model?.elementsAt(file, line) ?? [];
    const index = elements.findIndex((element) => isSameElement(element, this.session.focus.current));
    const nextElement = elements[(index + 1) % elements.length];
    if (nextElement) this.session.focus.select(nextElement);
  }
}

function createFocusHighlights(range: SourceRange | null): Highlight[] {
  return range ? [{ firstLine: range.line, lastLine: range.end_line, kind: "focus" }] : [];
}
