"""The page feature of spoken commands, which is created on demand."""

from linkwright.page.protocol import voice, voice_words
from linkwright.panels.on_demand import OnDemand

ON_DEMAND = (
    OnDemand(
        "linkwright.speech.page.feature:VoiceFeature",
        (
            voice_words.AskWordsFile,
            voice_words.BeginTake,
            voice_words.EndTake,
            voice_words.ImportWords,
            voice_words.RemoveWord,
            voice_words.RenameWord,
            voice.SayCommand,
            voice.SoundBlock,
            voice.Talk,
            voice.WatchVoice,
            voice_words.WatchWords,
        ),
        ("/voice/command",),
    ),
)
