"""The page feature of spoken commands, which is created on demand."""

from linkwright.panels.page_feature import OnDemand, messages

_VOICE = "linkwright.page.protocol.voice"
_WORDS = "linkwright.page.protocol.voice_words"

ON_DEMAND = (
    OnDemand(
        "linkwright.speech.page.feature:VoiceFeature",
        (
            *messages(_VOICE, "SayCommand", "SoundBlock", "Talk", "WatchVoice"),
            *messages(_WORDS, "AskWordsFile", "BeginTake", "EndTake", "ImportWords"),
            *messages(_WORDS, "RemoveWord", "RenameWord", "WatchWords"),
        ),
        ("/voice/command",),
    ),
)
