import { setDiagnosticsEffect } from "@codemirror/lint";
import type { LSPClient } from "@codemirror/lsp-client";
import { Prec, RangeSet, StateEffect, type Extension, type Range, type Text } from "@codemirror/state";
import { Decoration, EditorView, ViewPlugin, WidgetType, type DecorationSet, type ViewUpdate } from "@codemirror/view";
import { h } from "../../dom";
import { strings } from "../../strings";
import { parseHex, toHex, decodeTokens, type Color, type Legend } from "./server-meanings";
import { offsetOf, serverPositionOf, type ServerRange } from "./server-places";
import type { TextEdit } from "./workspace-edit";

/** The meaning of a text is requested this time after its last change, ms. */
const REQUEST_DELAY_MS = 250;
const MAX_HINT_LENGTH = 60;

interface Hint {
  readonly position: ServerRange["start"];
  readonly label: string | readonly { readonly value: string }[];
}
interface WrittenColor {
  readonly range: ServerRange;
  readonly color: Color;
}
/** The client's capabilities for values, names and colors, for the server. */
export const MEANING_CAPABILITIES = {
  textDocument: {
    inlayHint: {},
    colorProvider: {},
    semanticTokens: { requests: { range: true, full: true }, tokenTypes: [], tokenModifiers: ["definition"], formats: ["relative"] },
  },
};

const decorationsArrived = StateEffect.define<DecorationSet>();

/** The value of an expression, or the name of a parameter, beside the text. */
class HintWidget extends WidgetType {
  constructor(private readonly label: string) {
    super();
  }

  override eq(otherWidget: HintWidget): boolean {
    return otherWidget.label === this.label;
  }

  toDOM(): HTMLElement {
    const shortLabel = this.label.length > MAX_HINT_LENGTH ? `${this.label.slice(0, MAX_HINT_LENGTH)}…` : this.label;
    return h("span", { class: "cm-inlay-hint", title: this.label, aria: { hidden: "true" } }, shortLabel);
  }
}

/** A color before the text that writes it; a click changes it. */
class ColorWidget extends WidgetType {
  constructor(
    private readonly writtenColor: WrittenColor,
    private readonly openPicker: (view: EditorView, writtenColor: WrittenColor, swatch: HTMLElement) => void,
  ) {
    super();
  }

  override eq(otherWidget: ColorWidget): boolean {
    return JSON.stringify(otherWidget.writtenColor) === JSON.stringify(this.writtenColor);
  }

  toDOM(view: EditorView): HTMLElement {
    const swatch = h("span", { class: "cm-color", title: strings.sourceEditor.chooseColor, aria: { hidden: "true" } }, h("i"));
    const { red, green, blue, alpha } = this.writtenColor.color;
    (swatch.firstElementChild as HTMLElement).style.background = `rgb(${red * 255} ${green * 255} ${blue * 255} / ${alpha})`;
    swatch.addEventListener("mousedown", (event) => {
      event.preventDefault();
      this.openPicker(view, this.writtenColor, swatch);
    });
    return swatch;
  }

  override ignoreEvent(): boolean {
    return true;
  }
}

/** Requests values, names and colors of the visible text, and shows them. */
class Meanings {
  decorations: DecorationSet = Decoration.none;
  colors: readonly WrittenColor[] = [];
  private timer: ReturnType<typeof setTimeout> | undefined;
  private isClosed = false;

  constructor(
    private readonly view: EditorView,
    private readonly client: LSPClient,
    private readonly uri: string,
  ) {
    this.requestLater();
  }

  update({ docChanged, viewportChanged, changes, transactions }: ViewUpdate): void {
    if (docChanged) this.decorations = this.decorations.map(changes);
    const effects = transactions.flatMap((transaction) => transaction.effects);
    for (const effect of effects) if (effect.is(decorationsArrived)) this.decorations = effect.value;
    if (docChanged || viewportChanged || effects.some((effect) => effect.is(setDiagnosticsEffect))) this.requestLater();
  }

  destroy(): void {
    this.isClosed = true;
    clearTimeout(this.timer);
  }

  /** Opens the browser's choice of colors for a color of the text. */
  openPicker(writtenColor: WrittenColor, anchor: DOMRect): void {
    const field = h("input", { class: "cm-color-field", aria: { label: strings.sourceEditor.chooseColor } });
    field.type = "color";
    field.value = toHex(writtenColor.color);
    field.style.left = `${anchor.left}px`;
    field.style.top = `${anchor.bottom}px`;
    document.body.append(field);
    field.addEventListener("change", () => void this.write(writtenColor, field.value).finally(() => field.remove()));
    field.addEventListener("blur", () => field.remove());
    field.focus();
    field.showPicker();
  }

  private async write({ range, color }: WrittenColor, hex: string): Promise<void> {
    this.client.sync();
    const { doc } = this.view.state;
    const request = { textDocument: { uri: this.uri }, range, color: { ...parseHex(hex), alpha: color.alpha } };
    const [presentation] = (await this.client.request<object, { label: string; textEdit?: TextEdit }[] | null>("textDocument/colorPresentation", request)) ?? [];
    if (this.isClosed || presentation === undefined || this.view.state.doc !== doc) return;
    const edit = presentation.textEdit ?? { range, newText: presentation.label };
    this.view.dispatch({ changes: { from: offsetOf(doc, edit.range.start), to: offsetOf(doc, edit.range.end), insert: edit.newText }, userEvent: "action" });
    this.view.focus();
  }

  private requestLater(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.request().catch(() => undefined), REQUEST_DELAY_MS); // the next change repeats the request
  }

  private async request(): Promise<void> {
    const { client, view } = this;
    if (!client.connected) return;
    client.sync();
    const { doc } = view.state;
    const { from, to } = view.viewport;
    const textDocument = { uri: this.uri };
    const request = { textDocument, range: { start: serverPositionOf(doc, from), end: serverPositionOf(doc, to) } };
    const [hints, tokens, colors] = await Promise.all([
      this.sendRequest<Hint[]>("textDocument/inlayHint", request),
      this.sendRequest<{ data: number[] }>("textDocument/semanticTokens/range", request),
      this.sendRequest<WrittenColor[]>("textDocument/documentColor", { textDocument }),
    ]);
    if (this.isClosed || view.state.doc !== doc) return;
    this.colors = colors ?? [];
    const provider = client.serverCapabilities?.semanticTokensProvider as { legend: Legend } | undefined;
    const ranges = [
      ...(hints ?? []).map((hint) => createHint(doc, hint)),
      ...(provider ? decodeTokens(doc, tokens?.data ?? [], provider.legend).map(({ from, to, names }) => createNameMark(names).range(from, to)) : []),
      ...this.colors.map((color) => this.createSwatch(doc, color)),
    ];
    const decorations = RangeSet.of(ranges, true);
    if (RangeSet.eq([decorations], [this.decorations])) return; // drawing the same again would close a tooltip
    view.dispatch({ effects: decorationsArrived.of(decorations) });
  }

  private createSwatch(doc: Text, writtenColor: WrittenColor): Range<Decoration> {
    const openPicker = (_: EditorView, color: WrittenColor, element: HTMLElement): void => this.openPicker(color, element.getBoundingClientRect());
    return Decoration.widget({ widget: new ColorWidget(writtenColor, openPicker), side: -1 }).range(offsetOf(doc, writtenColor.range.start));
  }

  /** Returns the answer of the server; null if it has none because the text has changed. */
  private sendRequest<Result>(method: string, request: object): Promise<Result | null> {
    return this.client.request<object, Result | null>(method, request).catch(() => null);
  }
}

let plugin: ViewPlugin<Meanings, { client: LSPClient; uri: string }> | undefined;

function createPlugin(): ViewPlugin<Meanings, { client: LSPClient; uri: string }> {
  plugin ??= ViewPlugin.define<Meanings, { client: LSPClient; uri: string }>((view, { client, uri }) => new Meanings(view, client, uri), {
    decorations: ({ decorations }) => decorations,
  });
  return plugin;
}

/** Returns the extension that shows values of expressions, names by their meaning, and colors in a text. */
export function createMeanings(client: LSPClient, uri: string): Extension {
  // The meaning of a name takes precedence over its syntax, because the color of the inner element is visible.
  return Prec.highest(createPlugin().of({ client, uri }));
}

/** Returns a function that opens the choice of the color on the line of a position; null if there is no color. */
export function colorPickerAt(view: EditorView, position: number): (() => void) | null {
  const plugin = view.plugin(createPlugin());
  const line = view.state.doc.lineAt(position).number - 1;
  const writtenColor = plugin?.colors.find(({ range }) => range.start.line === line);
  if (!plugin || !writtenColor) return null;
  const anchor = view.coordsAtPos(offsetOf(view.state.doc, writtenColor.range.start)) ?? view.dom.getBoundingClientRect();
  return () => plugin.openPicker(writtenColor, new DOMRect(anchor.left, anchor.top, 0, anchor.bottom - anchor.top));
}

function createHint(doc: Text, { position, label }: Hint): Range<Decoration> {
  const text = typeof label === "string" ? label : label.map(({ value }) => value).join("");
  return Decoration.widget({ widget: new HintWidget(text), side: 1 }).range(offsetOf(doc, position));
}

function createNameMark(names: readonly string[]): Decoration {
  return Decoration.mark({ class: names.map((name) => `cm-token-${name}`).join(" ") });
}
