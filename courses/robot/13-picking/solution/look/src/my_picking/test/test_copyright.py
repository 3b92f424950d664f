from ament_copyright.main import main
import pytest


# Remove the skip once every source file names its copyright holder and license.
@pytest.mark.skip(reason='The generated files have no copyright header yet.')
@pytest.mark.copyright
@pytest.mark.linter
def test_copyright():
    assert main(argv=['.', 'test']) == 0, 'Files without a copyright header or license'
