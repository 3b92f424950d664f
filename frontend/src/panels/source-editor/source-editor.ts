import { redo, redoDepth, selectParentSyntax, undo, undoDepth } from "@codemirror/commands";
import { nextDiagnostic, openLintPanel, previousDiagnostic, diagnosticCount } from "@codemirror/lint";
import { formatDocument } from "@codemirror/lsp-client";
import { EditorState, type Transaction, type TransactionSpec } from "@codemirror/state";
import { EditorView, keymap } from "@codemirror/view";
import { createButton, coalesce, h } from "../../dom";
import { createIcon } from "../../icons";
import type { UnsavedTextEdited } from "../../protocol";
import { Signal } from "../../signal";
import type { Session } from "../../state/session";
import { strings } from "../../strings";
import type { Highlight } from "../description/source-view";
import { CodeActions } from "./code-actions";
import type { Documents, ServerFinding } from "./documents";
import { createBaseExtensions } from "./extensions";
import { FileTree } from "./file-tree";
import { showFindings } from "./findings";
import { LanguageService } from "./language-service";
import { LiveTexts } from "./live-texts";
import { inspectMarks, createMarkEffect } from "./marks";
import { Navigation } from "./navigation";
import { PlaceList } from "./place-list";
import { renameAtCursor } from "./rename";
import type { SourceDocument } from "./source-document";
import { SourceFiles } from "./source-files";
import { SymbolSearch } from "./symbol-search";
import { messageOf } from "./workspace-edit";
import "../../styles/source-editor.css";

/** The line at the cursor is reported this time after the last key, ms. */
const CURSOR_REPORT_DELAY_MS = 200;

/** The minimum width, px, at which the editor of a workspace lists the files without a request. */
const MIN_TREE_WIDTH_PX = 480;

/** The editor of the source files: one view, and the documents that it can show. */
export class SourceEditor implements Documents {
  readonly element: HTMLElement;
  readonly view: EditorView;
  /** A document was opened, shown, changed or saved. */
  readonly changed = new Signal();
  shownDocument: SourceDocument | null = null;
  private readonly findingsByUri = new Map<string, readonly ServerFinding[]>();
  private readonly files: SourceFiles;
  private readonly service: LanguageService;
  private readonly actions: CodeActions;
  private readonly navigation: Navigation;
  private readonly liveTexts: LiveTexts;
  private readonly places = new PlaceList(() => this.view.focus());
  private readonly tree: FileTree;
  private readonly notice = h("div", { class: "editor-notice", role: "alert" });
  private readonly status = h("span", { class: "editor-status", role: "status" });
  private readonly sceneStatus = h("span", { class: "editor-scene", role: "status" });
  private readonly saveButton: HTMLButtonElement;
  private readonly findingsButton: HTMLButtonElement;
  private requestedFile = "";
  private lineTimer: ReturnType<typeof setTimeout> | undefined;
  /** The document whose text was changed last. */
  private lastChanged: SourceDocument | null = null;

  /**
   * @param onCursorMoved - called with the file and the line of its description to which the user moved the cursor.
   */
  constructor(
    private readonly session: Session,
    private readonly onCursorMoved: (file: string, line: number) => void,
  ) {
    const texts = strings.sourceEditor;
    const { connection } = session;
    const showMessage = (message: string): void => this.showMessage(message);
    this.service = new LanguageService(connection, this);
    this.service.message.on(showMessage);
    this.actions = new CodeActions(this.service.client, this, (uri) => this.findingsByUri.get(uri) ?? [], showMessage);
    this.navigation = new Navigation(this.service.client, this, this.places, showMessage);
    this.liveTexts = new LiveTexts(connection, this, () => this.changed.emit());
    this.saveButton = createButton(texts.saveHint, () => this.saveAll(), "tool framed editor-save", createIcon("save"), texts.save);
    this.findingsButton = createButton(texts.findingsHint, () => openLintPanel(this.view), "tool framed", texts.findings(0));
    this.tree = new FileTree(connection, (path) => void this.show(path), (path) => void this.createAndShow(path));
    const filesButton = createButton(texts.filesHint, () => this.tree.toggle(), "tool framed", createIcon("tree"), texts.files);
    const formatButton = createButton(texts.formatHint, () => formatDocument(this.view), "tool framed", texts.format);
    const actionsButton = createButton(texts.actionsHint, () => this.actions.open(this.view), "tool framed", createIcon("bulb"), texts.actions);
    const symbolsButton = createButton(texts.symbolsHint, () => this.searchSymbols(), "tool framed", texts.symbols);
    const buttons = [filesButton, symbolsButton, this.saveButton, actionsButton, formatButton, this.findingsButton];
    const toolbar = h("div", { class: "editor-bar", role: "toolbar", aria: { label: texts.label } }, ...buttons, this.sceneStatus, this.status);
    this.tree.shownChanged.on((isShown) => filesButton.setAttribute("aria-expanded", String(isShown)));
    const withoutFile = [EditorView.editable.of(false), EditorView.contentAttributes.of({ "aria-label": texts.label })];
    this.view = new EditorView({ extensions: withoutFile, dispatchTransactions: (transactions, view) => this.dispatch(transactions, view) });
    const body = h("div", { class: "editor-body" }, this.tree.element, this.view.dom);
    this.element = h("div", { class: "source-editor" }, toolbar, this.notice, body, this.places.element);
    // The page's own keys would change the scene or save the configuration.
    this.element.addEventListener("keydown", (event) => event.key !== "F11" && event.stopPropagation());
    this.files = new SourceFiles(session, {
      createState: (path, uri, text, isReadOnly) => this.createState(path, uri, text, isReadOnly),
      change: (document, spec) => this.change(document, spec),
      onWorkspaceOpened: (folder, uri) => {
        this.service.connect(uri);
        this.tree.setFolder(folder);
        this.status.textContent = "";
        this.liveTexts.resendAll();
      },
      onAdded: (document) => this.service.add(document),
      onWritten: (document, isOwn) => this.onWritten(document, isOwn),
      onCreated: () => this.tree.reload(),
      showMessage,
    });
    this.files.changed.on(() => this.changed.emit());
    this.changed.on(coalesce(() => this.refresh()));
    connection.on("description_changed", () => {
      if (this.liveTexts.outcome !== null) return; // the language server has the unsaved texts
      const shownFiles = session.description.modelOf(this.shownDisplay)?.description.files ?? [];
      this.service.onFilesChanged(this.open.filter(({ path }) => shownFiles.includes(path)).map(({ uri }) => uri));
    });
    // A course checks its step again after programs, such as those in the terminal, have changed files.
    connection.on("step_checks", () => this.tree.reload());
    this.refresh();
  }

  get unavailableReason(): string | null {
    return this.files.unavailableReason;
  }

  get open(): readonly SourceDocument[] {
    return this.files.open;
  }

  get hasUnsaved(): boolean {
    return this.files.unsavedDocuments.length > 0;
  }

  /** Writes all files that have changed. */
  saveAll(): void {
    this.files.saveAll();
  }

  /** Shows a file, and returns whether it can be shown. */
  async show(path: string, load = (file: string) => this.load(file)): Promise<boolean> {
    this.requestedFile = path;
    const document = await load(path);
    if (document === null || this.requestedFile !== path) return document !== null;
    if (document !== this.shownDocument) this.displayDocument(document);
    return true;
  }

  /** Opens a workspace before any file of it, and lists its files. */
  openWorkspace(folder: string): void {
    this.files.openWorkspace(folder);
    requestAnimationFrame(() => {
      if (this.tree.element.hidden && this.element.clientWidth >= MIN_TREE_WIDTH_PX) this.tree.toggle();
    });
  }

  /** Shows a file, or an empty text that creates it when it is saved. */
  async showOrCreate(path: string): Promise<void> {
    await this.show(path, (file) => this.files.loadOrCreate(file));
  }

  load(path: string): Promise<SourceDocument | null> {
    return this.files.load(path);
  }

  create(path: string): Promise<void> {
    return this.files.create(path);
  }

  change(document: SourceDocument, spec: TransactionSpec): void {
    if (document === this.shownDocument) this.view.dispatch(spec);
    else this.record(document, document.state.update(spec));
  }

  onFindings(uri: string, findings: readonly ServerFinding[]): void {
    this.findingsByUri.set(uri, findings);
    if (this.shownDocument?.uri === uri) this.showFindings(this.shownDocument);
    this.changed.emit();
  }

  isShownInScene(path: string): boolean {
    const { description, robots, diagnostics } = this.session;
    return diagnostics.some(({ file }) => file === path) || [...robots.keys()].some((display) => description.modelOf(display)?.description.files.includes(path) === true);
  }

  /** Applies an edit that was made in the scene to the unsaved text. */
  applyEdit({ path, base, text }: UnsavedTextEdited): void {
    void this.load(path).then((document) => {
      const spec = document?.onRobotEdited(text, base);
      if (document && spec) this.change(document, spec);
      else this.showMessage(strings.sourceEditor.robotNotEdited);
    });
  }

  /** Marks lines of the shown file, and scrolls to one of them; lines are those of the shown description. */
  showHighlights(highlights: readonly Highlight[], line: number | null): void {
    const document = this.shownDocument;
    if (!document) return;
    this.view.dispatch({ effects: [createMarkEffect(document, highlights)] });
    if (line === null || line < 1) return;
    const currentLine = document.currentLineOf(line);
    this.navigation.recordPosition();
    this.view.dispatch({ selection: { anchor: currentLine }, effects: EditorView.scrollIntoView(currentLine, { y: "center" }) });
  }

  /** The text that Undo and Redo of the robot's edits change while it is not saved; null if all texts are saved. */
  get history(): { canUndo: boolean; canRedo: boolean; undo: () => void; redo: () => void } | null {
    const document = this.lastChanged;
    if (!document?.isUnsaved) return null;
    const dispatch = (transaction: Transaction): void => this.apply(document, transaction);
    const [canUndo, canRedo] = [undoDepth(document.state) > 0, redoDepth(document.state) > 0];
    return { canUndo, canRedo, undo: () => undo({ state: document.state, dispatch }), redo: () => redo({ state: document.state, dispatch }) };
  }

  /** Returns the state of the editor, for tests. */
  inspect(): object {
    const { view, shownDocument } = this;
    return {
      file: shownDocument?.path ?? "",
      text: view.state.doc.toString(),
      marks: inspectMarks(view.state),
      findings: this.findingsByUri.get(shownDocument?.uri ?? "")?.map(({ code }) => code) ?? [],
      unsaved: this.files.unsavedDocuments.map(({ path }) => path),
      isConflict: shownDocument?.conflict !== null && shownDocument !== null,
      unavailableReason: this.unavailableReason,
      cursor: view.state.doc.lineAt(view.state.selection.main.head).number,
      scene: this.liveTexts.outcome,
    };
  }

  private get shownDisplay(): string {
    return this.session.focus.current?.display ?? this.session.robot?.display ?? "";
  }

  private onWritten(document: SourceDocument, isOwn: boolean): void {
    if (isOwn) this.service.client.notification("textDocument/didSave", { textDocument: { uri: document.uri } });
    else this.service.onFilesChanged([document.uri]);
    this.liveTexts.scheduleSending();
  }

  private searchSymbols(): boolean {
    const search = new SymbolSearch(this.service.client, this, (location) => void this.navigation.open(location));
    void search.open().catch((error: unknown) => this.showMessage(messageOf(error)));
    return true;
  }

  private async createAndShow(path: string): Promise<void> {
    try {
      await this.create(path);
      await this.show(path);
    } catch (error) {
      this.showMessage(messageOf(error));
    }
  }

  private createState(path: string, uri: string, doc: string, isReadOnly: boolean): EditorState {
    const { navigation, actions } = this;
    const keys = keymap.of([
      { key: "F2", run: (view) => renameAtCursor(view, this.service, this, (message) => this.showMessage(message)), preventDefault: true },
      { key: "F12", run: (view) => navigation.goToDefinition(view), preventDefault: true },
      { key: "Shift-F12", run: (view) => navigation.listReferences(view), preventDefault: true },
      { key: "Alt-ArrowLeft", mac: "Ctrl--", run: () => navigation.goBack(), preventDefault: true },
      { key: "Alt-ArrowRight", mac: "Ctrl-Shift--", run: () => navigation.goForward(), preventDefault: true },
      { key: "Mod-Shift-o", run: () => this.searchSymbols(), preventDefault: true },
      { key: "Mod-.", run: (view) => actions.open(view), preventDefault: true },
      { key: "F8", run: nextDiagnostic, shift: previousDiagnostic, preventDefault: true },
      { key: "Mod-i", run: selectParentSyntax, preventDefault: true },
    ]);
    const clicks = EditorView.domEventHandlers({
      mousedown: (event, view) => {
        const position = event.button === 0 && (event.ctrlKey || event.metaKey) ? view.posAtCoords({ x: event.clientX, y: event.clientY }) : null;
        return position !== null && navigation.goToDefinition(view, position);
      },
    });
    const followCursor = EditorView.updateListener.of(({ transactions }) => {
      if (transactions.some((transaction) => transaction.isUserEvent("select"))) this.followCursor();
    });
    return EditorState.create({ doc, extensions: [keys, createBaseExtensions(path, doc, isReadOnly), this.service.extensionFor({ uri, path }), clicks, followCursor] });
  }

  /** Reports the line of the cursor once the cursor rests. */
  private followCursor(): void {
    clearTimeout(this.lineTimer);
    this.lineTimer = setTimeout(() => {
      const { main } = this.view.state.selection;
      if (this.shownDocument && main.empty) this.onCursorMoved(this.shownDocument.path, this.shownDocument.describedLineOf(main.head));
    }, CURSOR_REPORT_DELAY_MS);
  }

  private displayDocument(document: SourceDocument): void {
    this.service.client.sync();
    this.navigation.recordPosition();
    if (this.shownDocument) this.shownDocument.scrollPosition = this.view.elementAtHeight(this.view.scrollDOM.scrollTop).from;
    this.shownDocument = document;
    this.view.setState(document.state);
    this.showFindings(document);
    const position = Math.min(document.scrollPosition, document.state.doc.length);
    this.view.dispatch({ effects: EditorView.scrollIntoView(position, { y: "start" }) });
    this.status.textContent = "";
    this.tree.setCurrent(document.path);
    this.changed.emit();
  }

  private showFindings({ uri, readOnlyReason }: SourceDocument): void {
    const openFix = readOnlyReason === "" ? (view: EditorView, range: { from: number; to: number }) => void this.actions.open(view, range) : null;
    this.view.dispatch(showFindings(this.view.state, this.findingsByUri.get(uri) ?? [], openFix));
  }

  private apply(document: SourceDocument, transaction: Transaction): void {
    if (document === this.shownDocument) this.view.dispatch(transaction);
    else this.record(document, transaction);
  }

  private dispatch(transactions: readonly Transaction[], view: EditorView): void {
    view.update(transactions);
    if (this.shownDocument) for (const transaction of transactions) this.record(this.shownDocument, transaction);
  }

  private record(document: SourceDocument, transaction: Transaction): void {
    document.record(transaction);
    if (!transaction.docChanged) return;
    this.service.record(document, transaction.changes);
    this.navigation.record(document, transaction.changes);
    this.lastChanged = document;
    this.liveTexts.scheduleSending();
    this.changed.emit();
  }

  private showMessage(message: string): void {
    if (message !== "") this.status.textContent = message;
  }

  private refresh(): void {
    const texts = strings.sourceEditor;
    const { shownDocument } = this;
    const { unsavedDocuments } = this.files;
    this.saveButton.disabled = unsavedDocuments.every(({ conflict }) => conflict !== null);
    this.element.classList.toggle("unsaved", unsavedDocuments.length > 0);
    this.saveButton.lastChild?.replaceWith(unsavedDocuments.length > 1 ? texts.saveMany(unsavedDocuments.length) : texts.save);
    const count = diagnosticCount(this.view.state);
    this.findingsButton.replaceChildren(texts.findings(count));
    this.findingsButton.disabled = count === 0;
    const { outcome } = this.liveTexts;
    const sceneText = outcome === null ? "" : texts.scene[outcome];
    if (this.sceneStatus.textContent !== sceneText) this.sceneStatus.textContent = sceneText;
    this.sceneStatus.classList.toggle("errors", outcome === "errors");
    this.showNotice(shownDocument);
    this.tree.setUnsaved(unsavedDocuments.map(({ path }) => path));
    this.session.editing.setTextHistory(this.history);
  }

  private showNotice(document: SourceDocument | null): void {
    const texts = strings.sourceEditor;
    this.notice.hidden = !document || (document.conflict === null && document.readOnlyReason === "" && !document.isNew);
    if (!document || this.notice.hidden) return;
    this.notice.classList.toggle("plain", document.isNew);
    if (document.conflict === null) {
      this.notice.replaceChildren(document.readOnlyReason || texts.isNew);
      return;
    }
    const finish = (spec: TransactionSpec | null): void => {
      if (spec) this.change(document, spec);
      this.changed.emit();
      this.view.focus();
    };
    const keepEdited = (): void => {
      document.keepMine();
      finish(null);
    };
    const keepButton = createButton(texts.keepMineHint, keepEdited, "tool framed", texts.keepMine);
    const diskButton = createButton(texts.takeDiskHint, () => finish(document.takeDisk()), "tool framed", texts.takeDisk);
    this.notice.replaceChildren(h("span", {}, texts.conflict), keepButton, diskButton);
  }
}
