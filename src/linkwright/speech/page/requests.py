"""The page feature for spoken commands, which is created on demand."""

from linkwright.panels.page_feature import OnDemand, list_message_paths

_VOICE_MODULE = "linkwright.page.protocol.voice"
_WORDS_MODULE = "linkwright.page.protocol.voice_words"

ON_DEMAND = (
    OnDemand(
        "linkwright.speech.page.feature:VoiceFeature",
        (
            *list_message_paths(_VOICE_MODULE, "SayCommand", "SoundBlock", "Talk", "WatchVoice"),
            *list_message_paths(_WORDS_MODULE, "BeginTake", "EndTake", "ImportWords", "RequestWordsFile"),
            *list_message_paths(_WORDS_MODULE, "RemoveWord", "RenameWord", "WatchWords"),
        ),
        ("/voice/command",),
    ),
)
