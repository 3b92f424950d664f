from my_mission.decisions import velocity


def test_it_drives_straight_to_a_ball_ahead():
    speed, turn = velocity(2.0, 0.0)
    assert 0.0 < speed <= 0.3
    assert turn == 0.0


def test_it_turns_to_a_ball_on_the_left():
    assert velocity(2.0, 0.5)[1] > 0.0


def test_it_turns_to_a_ball_on_the_right():
    assert velocity(2.0, -0.5)[1] < 0.0


def test_it_stops_near_the_ball():
    assert velocity(0.4, 0.1) == (0.0, 0.0)


def test_it_keeps_the_speed_limit():
    assert velocity(10.0, 0.0, speed=0.2)[0] <= 0.2
