import { createButton, h } from "../../dom";
import type { ServicesState } from "../../state/monitor/services";
import { strings } from "../../strings";
import { onVisibilityChange } from "../../widgets/visibility";
import type { Panel } from "../panel";
import { MessageTree } from "./message-tree";
import { createSuggestions } from "./suggestions";

/** Calls services as rqt_service_caller does: the request is a text in YAML, the response is shown as a tree. */
export class ServicesPanel implements Panel {
  readonly id = "services";
  readonly icon = "services";
  readonly element: HTMLElement;
  private readonly field = h("input", { class: "field wide", aria: { label: strings.monitor.services.service } });
  private readonly kind = h("span", { class: "note" });
  private readonly text = h("textarea", { class: "field message-text", aria: { label: strings.monitor.services.request } });
  private readonly callButton: HTMLButtonElement;
  private readonly result = h("p", { class: "note", role: "status" });
  private tree = new MessageTree(null);
  private readonly treeHost = h("div");
  private readonly suggestions = createSuggestions("linkwright-services");
  private shownRequest: object | null = null;
  private shownResponse: object | null = null;

  constructor(private readonly state: ServicesState) {
    const texts = strings.monitor.services;
    this.field.setAttribute("list", this.suggestions.element.id);
    this.field.placeholder = texts.service;
    this.text.spellcheck = false;
    this.callButton = createButton(texts.callHint, () => state.call(this.text.value), "tool", texts.call);
    const choose = (service: string): void => {
      if (service !== state.service) state.choose(service);
    };
    this.field.addEventListener("change", () => choose(this.field.value.trim()));
    const chooseListed = (): void => {
      if (state.isListed(this.field.value)) choose(this.field.value);
    };
    this.field.addEventListener("input", chooseListed);
    this.text.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) state.call(this.text.value);
    });
    const toolbar = h("div", { class: "toolbar" }, this.field, this.suggestions.element, this.kind, h("span", { class: "spacer" }), this.callButton);
    const columns = h("div", { class: "call-columns" }, this.text, h("div", { class: "scroll call-response" }, this.result, this.treeHost));
    this.element = h("div", { class: "panel monitor" }, toolbar, columns);
    state.listChanged.on(() => {
      this.suggestions.show(state.services.map(({ name, kind }) => [name, kind]));
      chooseListed(); // its name may have been typed before the list arrived
    });
    state.changed.on(() => this.show());
    onVisibilityChange(this.element, (isVisible) => state.watch(isVisible));
    this.show();
  }

  private show(): void {
    const texts = strings.monitor.services;
    const { service, request, response, isCalling } = this.state;
    if (document.activeElement !== this.field) this.field.value = service;
    this.kind.textContent = request?.kind ?? "";
    this.callButton.disabled = request === null || request.error !== null;
    this.text.disabled = this.callButton.disabled;
    if (request !== this.shownRequest) this.text.value = request?.text ?? "";
    this.shownRequest = request;
    const error = response?.error ?? request?.error ?? null;
    this.result.classList.toggle("wrong", error !== null);
    if (error !== null) this.result.textContent = error;
    else if (isCalling) this.result.textContent = texts.calling;
    else if (response) this.result.textContent = texts.answered((response.seconds * 1000).toFixed(response.seconds < 0.01 ? 1 : 0));
    else if (request) this.result.textContent = texts.hint;
    else this.result.textContent = service === "" ? texts.choose : texts.unknown;
    if (response === this.shownResponse) return;
    this.shownResponse = response;
    this.tree = new MessageTree(null);
    this.treeHost.replaceChildren(this.tree.element);
    if (response) this.tree.show(response.fields);
  }
}
