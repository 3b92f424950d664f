import type { DescriptionModel } from "../../state/description-model";
import type { Session } from "../../state/session";

/** Returns the description that the panels show: that of the selected link's robot, or else of the first robot. */
export function getCurrentModel(session: Session): DescriptionModel | undefined {
  const display = session.focus.current?.display ?? session.robot?.display;
  return display === undefined ? undefined : session.description.modelOf(display);
}
