import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { Session } from "../../state/session";
import type { TextStorage } from "../../storage";
import { strings } from "../../strings";
import type { Highlight } from "../description/source-view";
import type { SourceEditor } from "./source-editor";

const STORAGE_KEY = "linkwright.source-editor";
const ENABLED = "1";

/**
 * The place of the editor in the panel Source, and the button that shows it; the editor is loaded with its first file.
 */
export class EditorPane {
  readonly element = h("div", { class: "editor-pane" });
  /** Why there is no editor, if the user wants one. */
  readonly notice = h("p", { class: "empty editor-why-not", role: "status" });
  readonly toggle: HTMLButtonElement;
  private editor: SourceEditor | null = null;
  private isEnabled: boolean;
  /** Resolves when the editor is loaded; null unless it is being loaded. */
  private loadPromise: Promise<void> | null = null;
  /** The folder whose files can be edited without a description; empty if there is none. */
  private workspace = "";
  private loadFailure = "";
  /** The file that is to be shown. */
  private file: string | null = null;
  private highlights: readonly Highlight[] = [];
  private markedKey = "";
  /** The line to scroll to once the file is shown. */
  private pendingLine: { file: string; line: number } | null = null;

  /**
   * @param onLineClicked - called with the file and the line that the user clicked.
   * @param onChanged - called when another file is shown, or the editor is opened or closed.
   */
  constructor(
    private readonly session: Session,
    private readonly storage: TextStorage,
    private readonly onLineClicked: (file: string, line: number) => void,
    private readonly onChanged: (file: string | null) => void,
  ) {
    this.isEnabled = storage.getItem(STORAGE_KEY) === ENABLED;
    const texts = strings.sourceEditor;
    this.toggle = createButton(texts.editHint, () => this.setEnabled(!this.isEnabled), "tool framed", createIcon("code"), texts.edit);
    this.element.hidden = true;
    this.notice.hidden = true;
    this.updateToggle();
  }

  /** Whether the editor is in place of the text. */
  get isShown(): boolean {
    return this.isEnabled && this.editor !== null && !this.editor.unavailableReason && (this.editor.shownDocument !== null || this.hasWorkspace);
  }

  /** Whether files can be edited without a description. */
  get hasWorkspace(): boolean {
    return this.workspace !== "";
  }

  /** Opens the editor for the files of a folder, which it lists. */
  openWorkspace(folder: string): void {
    if (folder === this.workspace) return;
    this.workspace = folder;
    this.isEnabled = true;
    this.updateToggle();
    if (this.editor === null) void this.load();
    else this.editor.openWorkspace(folder);
  }

  /** Edits a file, which is created when it is saved if it does not exist. */
  async edit(path: string): Promise<void> {
    this.file = path;
    if (this.editor === null) await this.load();
    await this.editor?.showOrCreate(path);
  }

  get hasUnsaved(): boolean {
    return this.editor?.hasUnsaved ?? false;
  }

  /** Writes all files that have changed. */
  saveAll(): void {
    this.editor?.saveAll();
  }

  /** The files that are open in the editor. */
  get files(): readonly string[] {
    return this.isShown ? (this.editor?.open.map(({ path }) => path) ?? []) : [];
  }

  /**
   * Shows a file, if the user wants the editor; returns whether the editor shows it now.
   *
   * @param file - the path; null for a text that is not in a file on the disk.
   * @param highlights - the marked lines.
   * @param line - the line to scroll to; null for none.
   */
  show(file: string | null, highlights: readonly Highlight[], line: number | null): boolean {
    this.file = file;
    this.highlights = highlights;
    if (this.isEnabled && file !== null && this.loadPromise === null) {
      if (this.editor === null) void this.load();
      else if (this.editor.shownDocument?.path !== file) void this.editor.show(file);
    }
    if (file !== null && line !== null) this.pendingLine = { file, line };
    const isEdited = this.isShown && (file === null ? this.hasWorkspace : this.editor?.shownDocument?.path === file);
    if (isEdited) this.showHighlights();
    this.element.hidden = !isEdited;
    this.notice.textContent = this.loadFailure || (this.editor?.unavailableReason ?? "");
    this.notice.hidden = !this.isEnabled || file === null || this.notice.textContent === "";
    return isEdited;
  }

  inspect(): object | null {
    return this.isShown ? (this.editor?.inspect() ?? null) : { unavailableReason: this.notice.hidden ? "" : this.notice.textContent };
  }

  private showHighlights(): void {
    const key = JSON.stringify([this.file, this.highlights]);
    const line = this.pendingLine?.file === this.file ? this.pendingLine.line : null;
    if (key === this.markedKey && line === null) return;
    [this.markedKey, this.pendingLine] = [key, null];
    this.editor?.showHighlights(this.highlights, line);
  }

  private setEnabled(isEnabled: boolean): void {
    this.isEnabled = isEnabled;
    this.storage.setItem(STORAGE_KEY, isEnabled ? ENABLED : "");
    this.updateToggle();
    this.onChanged(this.file);
    if (this.isShown) this.editor?.view.focus();
  }

  private updateToggle(): void {
    const texts = strings.sourceEditor;
    this.toggle.setAttribute("aria-pressed", String(this.isEnabled));
    this.toggle.title = this.isEnabled ? texts.view : texts.editHint;
  }

  private load(): Promise<void> {
    this.loadPromise ??= this.loadEditor();
    return this.loadPromise;
  }

  private async loadEditor(): Promise<void> {
    try {
      const { SourceEditor } = await import("./source-editor");
      this.editor = new SourceEditor(this.session, this.onLineClicked);
    } catch {
      this.loadFailure = strings.sourceEditor.failed;
    }
    this.loadPromise = null;
    const { editor } = this;
    if (editor !== null) {
      this.element.append(editor.element);
      if (this.hasWorkspace) editor.openWorkspace(this.workspace);
      let lastKey = "";
      editor.changed.on(() => {
        const key = `${String(editor.unavailableReason)} ${editor.shownDocument?.path ?? ""} ${editor.open.length}`;
        if (key !== lastKey) this.onChanged(editor.shownDocument?.path ?? null);
        lastKey = key;
      });
    }
    this.onChanged(this.file);
  }
}
