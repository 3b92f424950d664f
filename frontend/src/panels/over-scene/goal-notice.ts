import { createButton, h } from "../../dom";
import { createIcon } from "../../icons";
import type { NavigationState } from "../../state/monitor/navigation";
import { strings } from "../../strings";

/**
 * The notice over the scene after a navigation goal failed: the reason, until another goal is accepted or the user
 * closes it.
 */
export class GoalNotice {
  readonly element = h("div", { class: "line-notice failed", role: "alert", data: { notice: "goal" } });

  constructor(navigation: NavigationState) {
    const texts = strings.monitor.navigation;
    const reason = h("div");
    const closeButton = createButton(strings.diagnostics.close, () => (this.element.hidden = true), "tool bare", createIcon("close"));
    this.element.append(h("header", {}, h("strong", {}, texts.failed), closeButton), reason);
    this.element.hidden = true;
    navigation.outcomeChanged.on((outcome) => {
      reason.textContent = outcome.reason;
      this.element.hidden = !outcome.failed;
    });
  }
}
