from ament_flake8.main import main_with_errors
import pytest


@pytest.mark.flake8
@pytest.mark.linter
def test_flake8():
    status, errors = main_with_errors(argv=[])
    assert status == 0, '\n'.join([f'{len(errors)} findings about code style:', *errors])
