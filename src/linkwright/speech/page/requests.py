"""The page feature for spoken commands, which is created on demand."""

from linkwright.panels.page_feature import OnDemand, messages

_VOICE_MODULE = "linkwright.page.protocol.voice"
_WORDS_MODULE = "linkwright.page.protocol.voice_words"

ON_DEMAND = (
    OnDemand(
        "linkwright.speech.page.feature:VoiceFeature",
        (
            *messages(_VOICE_MODULE, "SayCommand", "SoundBlock", "Talk", "WatchVoice"),
            *messages(_WORDS_MODULE, "BeginTake", "EndTake", "ImportWords", "RequestWordsFile"),
            *messages(_WORDS_MODULE, "RemoveWord", "RenameWord", "WatchWords"),
        ),
        ("/voice/command",),
    ),
)
