import { createButton, h } from "../dom";
import { createIcon } from "../icons";
import type { Folder } from "../protocol";
import type { ConfigurationState } from "../state/configuration";
import { strings } from "../strings";
import { Dialog } from "../widgets/dialog";

const EXTENSION = ".rviz";

/** Chooses a configuration file on the server from folders and `.rviz` files, or by typing a path. */
export class FileDialog {
  private readonly dialog: Dialog;
  private readonly list = h("ul", { class: "file-list", role: "listbox", aria: { label: strings.shell.folder } });
  private readonly folderLabel = h("span", { class: "file-folder" });
  private readonly problem = h("p", { class: "dialog-problem", role: "alert" });
  private readonly nameField = h("input", { class: "field wide" });
  private readonly upButton: HTMLButtonElement;
  private readonly stopListening: () => void;
  private folder: Folder | null = null;
  private isAccepted = false;

  constructor(
    private readonly state: ConfigurationState,
    private readonly kind: "open" | "save",
    private readonly onChosen: (path: string) => void,
    private readonly onCancelled: () => void = () => undefined,
  ) {
    const texts = strings.shell;
    this.nameField.setAttribute("aria-label", texts.fileName);
    this.nameField.spellcheck = false;
    if (kind === "save") this.nameField.value = state.fileName ?? `${texts.untitled}${EXTENSION}`;
    this.upButton = createButton(texts.folderUp, () => this.requestFolder(this.folder?.parent ?? null), "tool framed", createIcon("up"));
    this.dialog = new Dialog(
      kind === "open" ? texts.openTitle : texts.saveTitle,
      [
        h("div", { class: "file-place" }, this.upButton, this.folderLabel),
        this.list,
        h("label", { class: "form-field" }, h("span", {}, texts.fileName), this.nameField),
        this.problem,
      ],
      [
        { label: texts.cancel },
        { label: kind === "open" ? texts.openShort : texts.save, isPrimary: true, run: () => this.acceptPath() },
      ],
      "file-dialog",
    );
    this.list.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.nameField.addEventListener("input", () => this.update());
    this.stopListening = state.folders.on((folder) => this.showFolder(folder));
    this.dialog.element.addEventListener("close", () => {
      this.stopListening();
      if (!this.isAccepted) this.onCancelled();
    });
  }

  open(): void {
    this.dialog.open(this.nameField);
    this.nameField.setSelectionRange(0, Math.max(0, this.nameField.value.length - EXTENSION.length));
    this.update();
    this.requestFolder(null);
  }

  close(): void {
    this.dialog.close();
  }

  /** Shows why a folder cannot be listed; returns whether the dialog is open. */
  showProblem(message: string): boolean {
    if (!this.dialog.element.open) return false;
    this.problem.textContent = message;
    return true;
  }

  private requestFolder(path: string | null): void {
    this.problem.textContent = "";
    this.state.requestFolder(path);
  }

  private showFolder(folder: Folder): void {
    this.folder = folder;
    this.folderLabel.replaceChildren(h("bdi", {}, folder.path));
    this.folderLabel.title = folder.path;
    this.upButton.disabled = folder.parent === null;
    const entries = [
      ...folder.folders.map((name) => this.createEntry(name, true)),
      ...folder.files.map((name) => this.createEntry(name, false)),
    ];
    this.list.replaceChildren(...entries);
    if (entries.length === 0) {
      this.list.append(h("li", { class: "empty", role: "option", aria: { disabled: "true" } }, strings.shell.emptyFolder));
    }
    const [firstEntry] = entries;
    if (firstEntry) firstEntry.tabIndex = 0;
  }

  private createEntry(name: string, isFolder: boolean): HTMLLIElement {
    const entry = h("li", { role: "option", tabIndex: -1 }, createIcon(isFolder ? "folder" : "file"), name);
    const chooseEntry = (): void => {
      if (isFolder) this.requestFolder(joinPath(this.folder?.path ?? "", name));
      else {
        this.nameField.value = name;
        this.update();
        for (const row of this.list.children) row.setAttribute("aria-selected", String(row === entry));
      }
    };
    entry.addEventListener("click", chooseEntry);
    if (!isFolder) {
      entry.addEventListener("dblclick", () => {
        if (this.acceptPath()) this.close();
      });
    }
    return entry;
  }

  private onKeyDown(event: KeyboardEvent): void {
    const entries = [...this.list.querySelectorAll<HTMLLIElement>("[role=option]:not(.empty)")];
    const index = entries.indexOf(document.activeElement as HTMLLIElement);
    if (event.key === "ArrowDown") entries[Math.min(index + 1, entries.length - 1)]?.focus();
    else if (event.key === "ArrowUp") entries[Math.max(index - 1, 0)]?.focus();
    else if (event.key === "Enter" || event.key === " ") entries[index]?.click();
    else if (event.key === "Backspace" && !this.upButton.disabled) this.upButton.click();
    else return;
    event.preventDefault();
  }

  private update(): void {
    this.dialog.isReady = this.nameField.value.trim() !== "";
  }

  private acceptPath(): boolean {
    const name = this.nameField.value.trim();
    if (name === "") return false;
    const fileName = this.kind === "save" && !name.endsWith(EXTENSION) ? `${name}${EXTENSION}` : name;
    this.isAccepted = true;
    this.onChosen(/^([/~]|[A-Za-z]:[\\/])/.test(fileName) ? fileName : joinPath(this.folder?.path ?? "", fileName));
    return true;
  }
}

function joinPath(folder: string, name: string): string {
  if (folder === "" || /[/\\]$/.test(folder)) return folder + name;
  return `${folder}${folder.includes("\\") && !folder.includes("/") ? "\\" : "/"}${name}`;
}
