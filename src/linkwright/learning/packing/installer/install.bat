@echo off
rem Install Linkwright from this folder, without a network and without administrator's rights: install.bat [FOLDER]
rem It needs a Python of @PYTHONS@, or an archive of one in the folder 'python'.
setlocal
chcp 65001 >nul
set "here=%~dp0"
set "unpacked=%USERPROFILE%\linkwright-python"
set "found="

call :find
if not defined found call :unpack
if not defined found (
    type "%here%no-python.txt"
    set "status=1"
    goto end
)
"%found%" "%here%install.py" %*
set "status=%ERRORLEVEL%"

:end
rem A window that a double click opened stays until a key is pressed.
echo %CMDCMDLINE% | findstr /i /c:"%~nx0" >nul && pause
exit /b %status%

:find
for %%v in (@PYTHONS@) do call :try_launcher %%v
for %%v in (@DIGITS@) do call :try "%LOCALAPPDATA%\Programs\Python\Python%%v\python.exe"
call :try python
call :try python3
call :try "%unpacked%\python\python.exe"
exit /b

:try_launcher
if defined found exit /b
for /f "delims=" %%p in ('py -%1 -c "import sys; print(sys.executable)" 2^>nul') do call :try "%%p"
exit /b

:try
if defined found exit /b
%1 -c "import sys; sys.exit('%%d.%%d' %% sys.version_info[:2] not in '@PYTHONS@'.split())" >nul 2>nul && set "found=%~1"
exit /b

:unpack
for %%a in ("%here%python\*x86_64-pc-windows-msvc-install_only*.tar.gz") do (
    if not exist "%unpacked%" mkdir "%unpacked%"
    tar -xzf "%%a" -C "%unpacked%"
)
call :try "%unpacked%\python\python.exe"
exit /b
