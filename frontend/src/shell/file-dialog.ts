import { button, h } from "../dom";
import { icon } from "../icons";
import type { Folder } from "../protocol";
import type { ConfigurationState } from "../state/configuration";
import { strings } from "../strings";
import { Dialog } from "../widgets/dialog";

const EXTENSION = ".rviz";

/** Chooses a configuration file on the server from folders and `.rviz` files, or by typing a path. */
export class FileDialog {
  private readonly dialog: Dialog;
  private readonly list = h("ul", { class: "file-list", role: "listbox", aria: { label: strings.shell.folder } });
  private readonly place = h("span", { class: "file-folder" });
  private readonly problem = h("p", { class: "dialog-problem", role: "alert" });
  private readonly name = h("input", { class: "field wide" });
  private readonly up: HTMLButtonElement;
  private readonly stopListening: () => void;
  private folder: Folder | null = null;
  private isAccepted = false;

  constructor(
    private readonly state: ConfigurationState,
    private readonly kind: "open" | "save",
    private readonly onChosen: (path: string) => void,
    private readonly cancelled: () => void = () => undefined,
  ) {
    const texts = strings.shell;
    this.name.setAttribute("aria-label", texts.fileName);
    this.name.spellcheck = false;
    if (kind === "save") this.name.value = state.fileName ?? `${texts.untitled}${EXTENSION}`;
    this.up = button(texts.folderUp, () => this.ask(this.folder?.parent ?? null), "tool framed", icon("up"));
    this.dialog = new Dialog(
      kind === "open" ? texts.openTitle : texts.saveTitle,
      [
        h("div", { class: "file-place" }, this.up, this.place),
        this.list,
        h("label", { class: "form-field" }, h("span", {}, texts.fileName), this.name),
        this.problem,
      ],
      [
        { label: texts.cancel },
        { label: kind === "open" ? texts.openShort : texts.save, main: true, run: () => this.accept() },
      ],
      "file-dialog",
    );
    this.list.addEventListener("keydown", (event) => this.onKeyDown(event));
    this.name.addEventListener("input", () => this.update());
    this.stopListening = state.folders.on((folder) => this.show(folder));
    this.dialog.element.addEventListener("close", () => {
      this.stopListening();
      if (!this.isAccepted) this.cancelled();
    });
  }

  open(): void {
    this.dialog.open(this.name);
    this.name.setSelectionRange(0, Math.max(0, this.name.value.length - EXTENSION.length));
    this.update();
    this.ask(null);
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

  private ask(path: string | null): void {
    this.problem.textContent = "";
    this.state.requestFolder(path);
  }

  private show(folder: Folder): void {
    this.folder = folder;
    this.place.replaceChildren(h("bdi", {}, folder.path));
    this.place.title = folder.path;
    this.up.disabled = folder.parent === null;
    const entries = [
      ...folder.folders.map((name) => this.entry(name, true)),
      ...folder.files.map((name) => this.entry(name, false)),
    ];
    this.list.replaceChildren(...entries);
    if (entries.length === 0) {
      this.list.append(h("li", { class: "empty", role: "option", aria: { disabled: "true" } }, strings.shell.emptyFolder));
    }
    const [first] = entries;
    if (first) first.tabIndex = 0;
  }

  private entry(name: string, isFolder: boolean): HTMLLIElement {
    const entry = h("li", { role: "option", tabIndex: -1 }, icon(isFolder ? "folder" : "file"), name);
    const choose = (): void => {
      if (isFolder) this.ask(join(this.folder?.path ?? "", name));
      else {
        this.name.value = name;
        this.update();
        for (const other of this.list.children) other.setAttribute("aria-selected", String(other === entry));
      }
    };
    entry.addEventListener("click", choose);
    if (!isFolder) {
      entry.addEventListener("dblclick", () => {
        if (this.accept()) this.close();
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
    else if (event.key === "Backspace" && !this.up.disabled) this.up.click();
    else return;
    event.preventDefault();
  }

  private update(): void {
    this.dialog.ready = this.name.value.trim() !== "";
  }

  private accept(): boolean {
    const typed = this.name.value.trim();
    if (typed === "") return false;
    const named = this.kind === "save" && !typed.endsWith(EXTENSION) ? `${typed}${EXTENSION}` : typed;
    this.isAccepted = true;
    this.onChosen(/^([/~]|[A-Za-z]:[\\/])/.test(named) ? named : join(this.folder?.path ?? "", named));
    return true;
  }
}

function join(folder: string, name: string): string {
  if (folder === "" || /[/\\]$/.test(folder)) return folder + name;
  return `${folder}${folder.includes("\\") && !folder.includes("/") ? "\\" : "/"}${name}`;
}
