import type { LSPClient } from "@codemirror/lsp-client";
import { createButton, h } from "../../dom";
import { strings } from "../../strings";
import { Dialog } from "../../widgets/dialog";
import { shortenPath } from "../place";
import type { Documents } from "./documents";
import type { ServerLocation } from "./navigation";
import { pathOf, type ServerRange } from "./server-places";
import { matchesQuery } from "./symbol-match";
import { messageOf } from "./workspace-edit";

interface DocumentSymbol {
  readonly name: string;
  readonly detail?: string | null;
  readonly selectionRange: ServerRange;
  readonly children?: readonly DocumentSymbol[] | null;
}
interface WorkspaceSymbol {
  readonly name: string;
  readonly containerName?: string | null;
  readonly location: ServerLocation;
}

/** A symbol in the list: the depth is that of the element in its file. */
interface ListedSymbol {
  readonly name: string;
  readonly detail: string;
  readonly depth: number;
  readonly location: ServerLocation;
}

const SEARCH_DELAY_MS = 120;
const MAX_LISTED_SYMBOLS = 300;
let searchCount = 0;

/** The search for names in the shown file, or in the whole workspace. */
export class SymbolSearch {
  private readonly id = `symbols-${String(++searchCount)}`;
  private readonly field = h("input", { class: "field wide", role: "combobox" });
  private readonly list = h("div", { class: "symbol-list", role: "listbox" });
  private readonly status = h("p", { class: "hint", role: "status" });
  private readonly scopes: readonly [HTMLButtonElement, HTMLButtonElement];
  private readonly dialog: Dialog;
  private ofFile: readonly ListedSymbol[] = [];
  private listedSymbols: readonly ListedSymbol[] = [];
  private isWorkspaceWide = false;
  private chosenIndex = 0;
  private number = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** @param open - called with the place of the symbol that the user chose. */
  constructor(
    private readonly client: LSPClient,
    private readonly documents: Documents,
    open: (location: ServerLocation) => void,
  ) {
    const texts = strings.sourceEditor;
    this.scopes = [
      createButton(texts.symbolsOfFile, () => this.setWorkspaceWide(false), "tool framed", texts.symbolsOfFile),
      createButton(texts.symbolsOfAll, () => this.setWorkspaceWide(true), "tool framed", texts.symbolsOfAll),
    ];
    const attributes = { "aria-label": texts.symbolName, "aria-controls": this.id, "aria-expanded": "true", "aria-autocomplete": "list", autocomplete: "off" };
    for (const [name, value] of Object.entries(attributes)) this.field.setAttribute(name, value);
    this.field.placeholder = texts.symbolName;
    this.list.id = this.id;
    this.list.setAttribute("aria-label", texts.symbols);
    const openSelected = (): undefined => {
      const symbol = this.listedSymbols[this.chosenIndex];
      if (symbol) open(symbol.location);
    };
    const scopes = h("div", { class: "symbol-scopes", role: "group", aria: { label: texts.symbolsIn } }, ...this.scopes);
    this.dialog = new Dialog(texts.symbols, [scopes, this.field, this.list, this.status], [{ label: strings.shell.cancel }, { label: texts.goTo, run: openSelected, isPrimary: true }], "symbol-search");
    this.field.addEventListener("input", () => this.searchLater());
    this.dialog.element.addEventListener("keydown", (event) => this.onKeyDown(event), true);
    this.list.addEventListener("click", ({ target }) => {
      const option = target instanceof Element ? target.closest<HTMLElement>("[role=option]") : null;
      if (!option) return;
      this.selectOption([...this.list.children].indexOf(option));
      openSelected();
      this.dialog.close();
    });
  }

  /** Opens the search with the symbols of the shown file. */
  async open(): Promise<void> {
    const { shownDocument } = this.documents;
    if (!shownDocument) return;
    this.dialog.open(this.field);
    this.client.sync();
    const symbols = await this.client.request<object, DocumentSymbol[] | null>("textDocument/documentSymbol", { textDocument: { uri: shownDocument.uri } });
    this.ofFile = flattenSymbols(symbols ?? [], shownDocument.uri, 0);
    this.setWorkspaceWide(false);
  }

  private setWorkspaceWide(isWorkspaceWide: boolean): void {
    this.isWorkspaceWide = isWorkspaceWide;
    for (const [index, scope] of this.scopes.entries()) scope.setAttribute("aria-pressed", String((index === 1) === isWorkspaceWide));
    void this.search();
    this.field.focus();
  }

  private searchLater(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.search(), this.isWorkspaceWide ? SEARCH_DELAY_MS : 0);
  }

  private async search(): Promise<void> {
    const query = this.field.value.trim();
    this.number += 1;
    const requestNumber = this.number;
    if (!this.isWorkspaceWide) {
      const matchingSymbols = this.ofFile.filter(({ name, detail }) => matchesQuery(query, name) || matchesQuery(query, detail));
      this.showSymbols(query === "" ? matchingSymbols : matchingSymbols.map((symbol) => ({ ...symbol, depth: 0 })));
      return;
    }
    try {
      const symbols = (await this.client.request<object, WorkspaceSymbol[] | null>("workspace/symbol", { query })) ?? [];
      if (requestNumber === this.number) this.showSymbols(symbols.map((symbol) => toListedSymbol(symbol)));
    } catch (error) {
      this.status.textContent = messageOf(error);
    }
  }

  private showSymbols(symbols: readonly ListedSymbol[]): void {
    this.listedSymbols = symbols.slice(0, MAX_LISTED_SYMBOLS);
    this.list.replaceChildren(...this.listedSymbols.map((symbol, index) => this.createOption(symbol, index)));
    this.status.textContent = strings.sourceEditor.symbolCount(symbols.length);
    this.dialog.isReady = symbols.length > 0;
    this.selectOption(0);
  }

  private createOption({ name, detail, depth }: ListedSymbol, index: number): HTMLElement {
    const option = h("div", { class: "symbol", role: "option" }, h("span", {}, name), h("small", {}, detail));
    option.id = `${this.id}-${String(index)}`;
    option.style.setProperty("--level", String(depth));
    return option;
  }

  private selectOption(index: number): void {
    this.chosenIndex = Math.max(0, Math.min(index, this.listedSymbols.length - 1));
    for (const [i, option] of [...this.list.children].entries()) option.setAttribute("aria-selected", String(i === this.chosenIndex));
    const option = this.list.children[this.chosenIndex];
    option?.scrollIntoView({ block: "nearest" });
    if (option) this.field.setAttribute("aria-activedescendant", option.id);
    else this.field.removeAttribute("aria-activedescendant");
  }

  private onKeyDown(event: KeyboardEvent): void {
    const nextIndex = { ArrowDown: this.chosenIndex + 1, ArrowUp: this.chosenIndex - 1, PageDown: this.chosenIndex + 10, PageUp: this.chosenIndex - 10 }[event.key];
    if (event.target === this.field && nextIndex !== undefined) this.selectOption(nextIndex);
    else if ((event.ctrlKey || event.metaKey) && event.shiftKey && event.key.toLowerCase() === "o") this.setWorkspaceWide(!this.isWorkspaceWide);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}

function flattenSymbols(symbols: readonly DocumentSymbol[], uri: string, depth: number): ListedSymbol[] {
  return symbols.flatMap(({ name, detail, selectionRange, children }) => [
    { name, detail: detail ?? "", depth, location: { uri, range: selectionRange } },
    ...flattenSymbols(children ?? [], uri, depth + 1),
  ]);
}

function toListedSymbol({ name, location, containerName }: WorkspaceSymbol): ListedSymbol {
  const path = pathOf(location.uri);
  const file = path === null ? (containerName ?? "") : shortenPath(path);
  return { name, detail: `${file}:${location.range.start.line + 1}`, depth: 0, location };
}
