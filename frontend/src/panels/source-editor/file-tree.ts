import type { Connection } from "../../connection/connection";
import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import { Signal } from "../../signal";
import { strings } from "../../strings";

interface FolderEntries {
  readonly folders: readonly string[];
  readonly files: readonly string[];
}

/** The files of the workspace as a tree, whose folders are read when they are opened. */
export class FileTree {
  readonly element: HTMLElement;
  readonly shownChanged = new Signal<boolean>();
  private readonly list = h("div", { class: "file-tree-list", role: "tree", aria: { label: strings.sourceEditor.tree } });
  private readonly nameField = h("input", { class: "field file-tree-name" });
  private readonly folders = new Map<string, FolderEntries>();
  private readonly expandedFolders = new Set<string>();
  private root = "";
  private currentPath = "";
  private unsavedPaths: ReadonlySet<string> = new Set();
  /** The path of the item that the Tab key reaches. */
  private tabStopPath = "";

  /**
   * @param onFileChosen - called with the path of a file to show.
   * @param onFileCreated - called with the path of a file to create.
   */
  constructor(
    private readonly connection: Connection,
    private readonly onFileChosen: (path: string) => void,
    onFileCreated: (path: string) => void,
  ) {
    const texts = strings.sourceEditor;
    this.nameField.placeholder = texts.newFilePath;
    this.nameField.setAttribute("aria-label", texts.newFilePath);
    this.nameField.hidden = true;
    const newFileButton = createButton(texts.newFileHint, () => this.askName(), "tool bare", createIcon("plus"), texts.newFile);
    this.nameField.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.nameField.hidden = true;
      if (event.key !== "Enter" || this.nameField.value.trim() === "") return;
      onFileCreated(joinPath(this.root, this.nameField.value.trim()));
      this.nameField.hidden = true;
    });
    this.element = h("nav", { class: "file-tree", aria: { label: texts.tree } }, h("div", { class: "file-tree-head" }, newFileButton), this.nameField, this.list);
    this.element.hidden = true;
    this.list.addEventListener("click", (event) => this.activate(findItem(event.target)));
    this.list.addEventListener("keydown", (event) => this.onKeyDown(event));
    connection.on("source_folder", ({ path, folders, files }) => {
      this.folders.set(path, { folders, files });
      this.draw();
    });
  }

  toggle(): void {
    this.element.hidden = !this.element.hidden;
    this.shownChanged.emit(!this.element.hidden);
    if (!this.element.hidden) this.reload();
  }

  setFolder(root: string): void {
    if (root !== this.root) this.folders.clear();
    this.root = root;
    this.tabStopPath = "";
    this.expandTo(this.currentPath);
    this.reload();
  }

  setCurrent(path: string): void {
    this.currentPath = path;
    this.expandTo(path);
    this.draw();
  }

  setUnsaved(paths: readonly string[]): void {
    if (paths.length === this.unsavedPaths.size && paths.every((path) => this.unsavedPaths.has(path))) return;
    this.unsavedPaths = new Set(paths);
    this.draw();
  }

  /** Reads the shown folders again. */
  reload(): void {
    if (this.element.hidden || this.root === "") return;
    for (const path of [this.root, ...this.expandedFolders]) this.request(path);
  }

  private request(path: string): void {
    this.connection.send({ type: "request_source_folder", path });
  }

  private expandTo(path: string): void {
    if (this.root === "" || !path.startsWith(this.root)) return;
    const parts = path.slice(this.root.length).split("/").filter((part) => part !== "");
    let folder = this.root;
    for (const part of parts.slice(0, -1)) {
      folder = joinPath(folder, part);
      if (this.expandedFolders.has(folder)) continue;
      this.expandedFolders.add(folder);
      if (!this.element.hidden) this.request(folder);
    }
  }

  private askName(): void {
    this.nameField.hidden = false;
    const folder = this.currentPath.startsWith(this.root) ? this.currentPath.slice(this.root.length + 1).replace(/[^/]*$/, "") : "";
    this.nameField.value = folder;
    this.nameField.focus();
  }

  private draw(): void {
    const items: HTMLElement[] = [];
    const hadFocus = this.list.contains(document.activeElement);
    this.addItems(items, this.root, 1);
    if (!items.some((item) => item.dataset["path"] === this.tabStopPath)) this.tabStopPath = items[0]?.dataset["path"] ?? "";
    for (const item of items) item.tabIndex = item.dataset["path"] === this.tabStopPath ? 0 : -1;
    this.list.replaceChildren(...items);
    if (hadFocus) this.focus(this.tabStopPath);
  }

  private addItems(items: HTMLElement[], folder: string, level: number): void {
    const entries = this.folders.get(folder);
    if (!entries) return;
    for (const name of entries.folders) {
      const path = joinPath(folder, name);
      const isOpen = this.expandedFolders.has(path);
      const item = createTreeItem(path, level, createIcon("chevron"), name);
      item.setAttribute("aria-expanded", String(isOpen));
      items.push(item);
      if (isOpen) this.addItems(items, path, level + 1);
    }
    for (const name of entries.files) {
      const path = joinPath(folder, name);
      const isUnsaved = this.unsavedPaths.has(path);
      const item = createTreeItem(path, level, createIcon("file"), name);
      item.setAttribute("aria-selected", String(path === this.currentPath));
      if (isUnsaved) item.append(h("span", { class: "file-tree-unsaved", title: strings.sourceEditor.unsaved, aria: { label: strings.sourceEditor.unsaved }, role: "img" }, "●"));
      items.push(item);
    }
  }

  private activate(item: HTMLElement | null): void {
    const path = item?.dataset["path"];
    if (!item || path === undefined) return;
    this.tabStopPath = path;
    if (!item.hasAttribute("aria-expanded")) {
      this.draw();
      this.onFileChosen(path);
    } else this.setExpanded(path, !this.expandedFolders.has(path));
  }

  private setExpanded(path: string, isOpen: boolean): void {
    if (isOpen) {
      this.expandedFolders.add(path);
      this.request(path);
    } else this.expandedFolders.delete(path);
    this.draw();
    this.focus(path);
  }

  private onKeyDown(event: KeyboardEvent): void {
    const item = findItem(event.target);
    const path = item?.dataset["path"];
    if (!item || path === undefined) return;
    const items = [...this.list.querySelectorAll<HTMLElement>("[role=treeitem]")];
    const index = items.indexOf(item);
    const nextIndex = { ArrowDown: index + 1, ArrowUp: index - 1, Home: 0, End: items.length - 1 }[event.key];
    const expandedState = item.getAttribute("aria-expanded");
    if (nextIndex !== undefined) this.focus(items[nextIndex]?.dataset["path"] ?? path);
    else if (event.key === "Enter" || event.key === " ") this.activate(item);
    else if (event.key === "ArrowRight" && expandedState === "false") this.setExpanded(path, true);
    else if (event.key === "ArrowLeft" && expandedState === "true") this.setExpanded(path, false);
    else if (event.key === "ArrowLeft") this.focus(path.replace(/\/[^/]*$/, ""));
    else return;
    event.preventDefault();
  }

  private focus(path: string): void {
    const items = [...this.list.querySelectorAll<HTMLElement>("[role=treeitem]")];
    const item = items.find((candidate) => candidate.dataset["path"] === path);
    if (!item) return;
    this.tabStopPath = path;
    for (const candidate of items) candidate.tabIndex = candidate === item ? 0 : -1;
    item.focus();
  }
}

function createTreeItem(path: string, level: number, ...content: (Node | string)[]): HTMLElement {
  const item = h("div", { class: "file-tree-item", role: "treeitem", title: path, data: { path }, aria: { level: String(level) } }, ...content);
  item.style.setProperty("--level", String(level));
  return item;
}

function findItem(target: EventTarget | null): HTMLElement | null {
  return target instanceof Element ? target.closest<HTMLElement>("[role=treeitem]") : null;
}

function joinPath(folder: string, name: string): string {
  return `${folder.replace(/\/$/, "")}/${name}`;
}
