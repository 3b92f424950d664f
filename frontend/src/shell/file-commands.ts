import type { ConfigurationRefused, EditName } from "../protocol";
import type { ConfigurationState } from "../state/configuration";
import { strings } from "../strings";
import { Dialog, showNotice } from "../widgets/dialog";
import { saveText } from "../widgets/save-file";
import { FileDialog } from "./file-dialog";

/** The maximum size of a file in bytes, so that it fits into a message to the server with its quotes escaped. */
const MAX_BYTES = 800_000;
const CONTENT_TYPE = "application/yaml";

/** The commands on the configuration file, with questions before changes are lost. */
export class FileCommands {
  /** The pending request, repeated if the user agrees to lose changes. */
  private pending: ((discard: boolean) => void) | null = null;
  /** Called once the file is saved. */
  private afterSaving: (() => void) | null = null;
  private dialog: FileDialog | null = null;

  constructor(private readonly state: ConfigurationState) {
    state.refused.on((refusal) => this.onRefused(refusal));
    state.saved.on(() => {
      const next = this.afterSaving;
      this.afterSaving = null;
      next?.();
    });
    state.texts.on(({ name, text }) => saveText(name, text, CONTENT_TYPE));
    window.addEventListener("beforeunload", (event) => {
      // The shared configuration survives in the program; a page's own configuration ends with the page.
      if (state.current.own && state.current.unsaved) event.preventDefault();
    });
  }

  begin(): void {
    this.ask((discard) => this.state.createFile(discard));
  }

  open(path: string): void {
    this.ask((discard) => this.state.open(path, discard));
  }

  /** Lets the user choose a file on the server. */
  chooseFile(): void {
    this.show(new FileDialog(this.state, "open", (path) => this.open(path)));
  }

  /** Lets the user choose a file on the browser's machine. */
  chooseLocal(): void {
    const input = document.createElement("input");
    input.type = "file";
    input.accept = ".rviz,.yaml,.yml";
    input.addEventListener("change", () => {
      const file = input.files?.[0];
      if (!file) return;
      if (file.size > MAX_BYTES) showNotice(strings.shell.refused, strings.shell.tooLarge(file.name));
      else void file.text().then((text) => this.ask((discard) => this.state.load(file.name, text, discard)));
    });
    input.click();
  }

  save(): void {
    if (this.state.current.path === null) this.saveAs();
    else this.state.save();
  }

  saveAs(): void {
    const cancelled = (): void => {
      this.afterSaving = null;
    };
    this.show(new FileDialog(this.state, "save", (path) => this.state.save(path), cancelled));
  }

  download(): void {
    this.state.requestText();
  }

  revert(): void {
    const texts = strings.shell;
    new Dialog(
      texts.revert,
      [texts.revertQuestion],
      [
        { label: texts.cancel, main: true },
        {
          label: texts.revert,
          danger: true,
          run: () => {
            this.state.revert();
            return undefined;
          },
        },
      ],
    ).open();
  }

  private show(dialog: FileDialog): void {
    this.dialog?.close();
    this.dialog = dialog;
    dialog.open();
  }

  private ask(what: (discard: boolean) => void): void {
    this.pending = what;
    what(false);
  }

  private onRefused(refusal: ConfigurationRefused): void {
    const texts = strings.shell;
    switch (refusal.question) {
      case "unsaved":
        this.askToDiscard();
        break;
      case "exists":
        this.askToReplace(texts.exists, texts.existsQuestion(refusal.path ?? ""), refusal.path);
        break;
      case "changed_on_disk":
        this.askToReplace(texts.changedOnDisk, texts.changedOnDiskQuestion(refusal.path ?? ""), refusal.path);
        break;
      case null:
        this.afterSaving = null;
        if (this.dialog?.showProblem(refusal.message) !== true) showNotice(texts.refused, refusal.message);
        break;
    }
  }

  private askToDiscard(): void {
    const texts = strings.shell;
    const again = this.pending;
    const proceed = (): undefined => {
      again?.(true);
      return undefined;
    };
    new Dialog(
      texts.unsavedTitle,
      [texts.unsavedQuestion(this.state.fileName ?? texts.untitled)],
      [
        { label: texts.cancel },
        { label: texts.discard, danger: true, run: proceed },
        {
          label: texts.saveFirst,
          main: true,
          run: () => {
            this.afterSaving = proceed;
            this.save();
            return undefined;
          },
        },
      ],
    ).open();
  }

  private askToReplace(title: string, question: string, path: string | null): void {
    const texts = strings.shell;
    new Dialog(
      title,
      [question],
      [
        { label: texts.cancel, main: true },
        {
          label: texts.replace,
          danger: true,
          run: () => {
            this.state.save(path, true);
            return undefined;
          },
        },
      ],
    ).open();
  }
}

/** Returns an edit in words: `adding Grid`. */
export function editText(edit: EditName): string {
  return strings.shell.edits[edit.kind](edit.name);
}
