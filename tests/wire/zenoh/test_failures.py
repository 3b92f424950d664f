from __future__ import annotations

from tests.wire.test_failures import (  # noqa: F401 - the same over Zenoh
    test_a_kept_message_that_cannot_be_written_is_told_and_the_others_are_sent,
    test_a_message_that_fails_on_its_way_in_takes_no_other_with_it,
    test_a_request_and_a_response_that_fail_on_their_way_in_are_told,
    test_a_request_that_waited_and_cannot_be_written_fails_and_the_next_is_answered,
    test_who_watches_the_graph_and_fails_keeps_nobody_from_knowing_it,
)
