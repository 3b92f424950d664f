import type { ConfigurationRefused, EditName } from "../protocol";
import type { ConfigurationState } from "../state/configuration";
import { strings } from "../strings";
import { Dialog, showNotice } from "../widgets/dialog";
import { saveText } from "../widgets/save-file";
import { FileDialog } from "./file-dialog";

/** The maximum size of a file in bytes: with its quotes escaped, it must fit into a message to the server. */
const MAX_FILE_BYTES = 800_000;
const CONTENT_TYPE = "application/yaml";

/** The commands on the configuration file. They ask before changes are lost. */
export class FileCommands {
  /** The pending request, which is repeated if the user agrees to discard changes. */
  private pendingRequest: ((discardsChanges: boolean) => void) | null = null;
  /** Called after the file has been saved. */
  private onSaved: (() => void) | null = null;
  private dialog: FileDialog | null = null;

  constructor(private readonly state: ConfigurationState) {
    state.refused.on((refusal) => this.onRefused(refusal));
    state.saved.on(() => {
      const onSaved = this.onSaved;
      this.onSaved = null;
      onSaved?.();
    });
    state.texts.on(({ name, text }) => saveText(name, text, CONTENT_TYPE));
    window.addEventListener("beforeunload", (event) => {
      // The server keeps the shared configuration; a page's own configuration is lost with the page.
      if (state.current.is_own && state.current.unsaved) event.preventDefault();
    });
  }

  createFile(): void {
    this.sendRequest((discardsChanges) => this.state.createFile(discardsChanges));
  }

  open(path: string): void {
    this.sendRequest((discardsChanges) => this.state.open(path, discardsChanges));
  }

  /** Lets the user choose a file on the server. */
  chooseFile(): void {
    this.openDialog(new FileDialog(this.state, "open", (path) => this.open(path)));
  }

  /** Lets the user choose a file on the browser's machine. */
  chooseLocal(): void {
    const input = document.createElement("input");
    input.type = "file";
    input.accept = ".rviz,.yaml,.yml";
    input.addEventListener("change", () => {
      const file = input.files?.[0];
      if (!file) return;
      if (file.size > MAX_FILE_BYTES) showNotice(strings.shell.refused, strings.shell.tooLarge(file.name));
      else void file.text().then((text) => this.sendRequest((discardsChanges) => this.state.load(file.name, text, discardsChanges)));
    });
    input.click();
  }

  save(): void {
    if (this.state.current.path === null) this.saveAs();
    else this.state.save();
  }

  saveAs(): void {
    const onCancelled = (): void => {
      this.onSaved = null;
    };
    this.openDialog(new FileDialog(this.state, "save", (path) => this.state.save(path), onCancelled));
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
        { label: texts.cancel, isPrimary: true },
        {
          label: texts.revert,
          isDangerous: true,
          run: () => {
            this.state.revert();
            return undefined;
          },
        },
      ],
    ).open();
  }

  private openDialog(dialog: FileDialog): void {
    this.dialog?.close();
    this.dialog = dialog;
    dialog.open();
  }

  private sendRequest(request: (discardsChanges: boolean) => void): void {
    this.pendingRequest = request;
    request(false);
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
        this.onSaved = null;
        if (this.dialog?.showProblem(refusal.message) !== true) showNotice(texts.refused, refusal.message);
        break;
    }
  }

  private askToDiscard(): void {
    const texts = strings.shell;
    const request = this.pendingRequest;
    const proceed = (): undefined => {
      request?.(true);
      return undefined;
    };
    new Dialog(
      texts.unsavedTitle,
      [texts.unsavedQuestion(this.state.fileName ?? texts.untitled)],
      [
        { label: texts.cancel },
        { label: texts.discard, isDangerous: true, run: proceed },
        {
          label: texts.saveFirst,
          isPrimary: true,
          run: () => {
            this.onSaved = proceed;
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
        { label: texts.cancel, isPrimary: true },
        {
          label: texts.replace,
          isDangerous: true,
          run: () => {
            this.state.save(path, true);
            return undefined;
          },
        },
      ],
    ).open();
  }
}

/** Returns the text that describes an edit: `adding Grid`. */
export function formatEdit(edit: EditName): string {
  return strings.shell.edits[edit.kind](edit.name);
}
