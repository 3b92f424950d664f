from ament_pep257.main import main
import pytest


@pytest.mark.pep257
@pytest.mark.linter
def test_pep257():
    assert main(argv=['.', 'test']) == 0, 'Docstrings that do not follow PEP 257'
