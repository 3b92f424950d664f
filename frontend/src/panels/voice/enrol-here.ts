import { button } from "../../dom";
import type { VoiceState } from "../../state/voice/voice";
import type { WordsState } from "../../state/voice/words";
import { strings } from "../../strings";

/** Whether the robot proposes to enrol words where the user stands, and the user has not begun to. */
export function proposesEnrolling(voice: VoiceState, words: WordsState): boolean {
  return voice.told?.proposes_enrolling === true && words.here === null;
}

/** A button that has the user say the words where they stand. */
export function enrolHereButton(words: WordsState): HTMLButtonElement {
  const { enrolHere, enrolHereHint } = strings.voice.words;
  return button(enrolHereHint, () => words.enrolWanted.emit(), "tool framed primary", enrolHere);
}
