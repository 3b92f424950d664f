import type { Connection } from "../../connection/connection";
import { h } from "../../dom";
import { strings } from "../../strings";

/** The notice over the scene while there is no connection, so that the scene is out of date. */
export class ConnectionNotice {
  readonly element = h("div", { class: "notice", role: "alert" });

  constructor(private readonly connection: Connection) {
    connection.stateChanged.on(() => this.update());
    this.update();
  }

  private update(): void {
    const { state } = this.connection;
    const texts = strings.connection;
    this.element.hidden = state === "connecting" || state === "connected";
    this.element.dataset["state"] = state;
    this.element.replaceChildren(
      h("span", { class: "pulse" }),
      h("strong", {}, texts[state]),
      state === "ended" ? h("span", {}, texts.endedHint) : "",
      state === "refused" ? h("span", {}, texts.refusedHint) : "",
    );
  }
}
